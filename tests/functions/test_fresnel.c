/* The C reference's Fresnel reflectance at float, against closed forms and the textbook's formulas.
 */
#include "../cmocka_test.h"

#include "dielectric.h"
#include "packed_glass.h"
#include "random.h"

#ifndef CASES
#define CASES 1000000
#endif

static const double half_ulp = 0x1p-24; /* of 1: the relative error of one operation */

static struct refraction refract_at(struct packed_glass glass, double cos_in)
{
    const struct vec3 normal = {0, 0, 1};
    struct vec3 direction = {(float)sqrt(1 - cos_in * cos_in), 0, -(float)cos_in};
    return refract(direction, normal, (float)cos_in, glass.eta, glass.kappa);
}

static double reflectance_at(double ior, bool entering, double cos_in)
{
    struct refraction refraction = refract_at(pack_glass(ior, entering), cos_in);
    assert_false(refraction.total);
    return (double)refraction.reflectance;
}

static void assert_relative(double found, double right, double operations)
{
    if (!(fabs(found - right) <= operations * half_ulp * fabs(right)))
        fail_msg("%.9g, but it should be %.9g: off by %.3g roundings, allowed are %g", found, right,
                 fabs(found - right) / (half_ulp * fabs(right)), operations);
}

static const double indices[] = {1 + 1e-6, 1 - 1e-6, 0.75, 1.3, 1.5, 2.42, 4};
enum { INDICES = sizeof indices / sizeof *indices };

/* Of the product r_s^2: kappa and eta are off by one each, and from them to r_s are three operations. */
static const double reflectance_operations = 12;

static void test_normal_incidence(void **state)
{
    (void)state;
    for (int i = 0; i < INDICES; ++i) {
        double r = (indices[i] - 1) / (indices[i] + 1);
        assert_relative(reflectance_at(indices[i], true, 1), r * r, reflectance_operations);
        assert_relative(reflectance_at(indices[i], false, 1), r * r, reflectance_operations);
    }
}

/* Where refracted and reflected rays are perpendicular, r_p = 0, cos_out = sin_in and r_s = (1 - n^2) / (1 +
 * n^2). On the way out of a dense body cos_out^2 is the small difference of kappa and eta^2 cos_in^2. */
static void assert_brewster(double n, bool entering)
{
    double r_s = (1 - n * n) / (1 + n * n), eta = entering ? 1 / n : n;
    double cos_in = eta / sqrt(1 + eta * eta), cos_out = 1 / sqrt(1 + eta * eta);
    double cancelled = (fabs(1 - eta * eta) + eta * eta * cos_in * cos_in) / (cos_out * cos_out);
    assert_relative(reflectance_at(n, entering, cos_in), r_s * r_s / 2, reflectance_operations + cancelled);
}

static void test_brewster(void **state)
{
    (void)state;
    for (int i = 0; i < INDICES; ++i) {
        assert_brewster(indices[i], true);
        assert_brewster(indices[i], false);
    }
}

static void test_critical_angle(void **state)
{
    (void)state;
    static const double dense[] = {1 + 1e-4, 1.3, 1.5, 2.42, 4};
    for (size_t i = 0; i < sizeof dense / sizeof *dense; ++i) {
        double n = dense[i], critical = sqrt((n - 1) * (n + 1)) / n;
        assert_true(refract_at(pack_glass(n, false), critical * (1 - 1e-6)).total);
        assert_true(refract_at(pack_glass(n, false), 0).total);
        assert_false(refract_at(pack_glass(n, false), critical * (1 + 1e-6)).total);
        /* Above it, 1 - k_r is 2 sqrt(2) (1 + n^2) times the root of the distance, at first. */
        double before = 1;
        for (double above = 1e-6; above < 1e-2; above *= 4) {
            double k_r = reflectance_at(n, false, fmin(1, critical * (1 + above)));
            assert_true(k_r < before && k_r > 1 - 3 * (1 + n * n) * sqrt(above));
            before = k_r;
        }
        /* Into the thinner body from outside it is the same with the sides exchanged. */
        assert_true(refract_at(pack_glass(1 / n, true), critical * (1 - 1e-6)).total);
        assert_false(refract_at(pack_glass(1 / n, true), critical * (1 + 1e-6)).total);
    }
}

/* 1 - k_r = 2 cos_in (1 / (n cos_out) + n / cos_out) + O(cos_in^2) with cos_out that of the critical angle.
 */
static void test_grazing(void **state)
{
    (void)state;
    static const double dense[] = {1.3, 1.5, 2.42, 4};
    for (size_t i = 0; i < sizeof dense / sizeof *dense; ++i) {
        double n = dense[i], cos_out = sqrt((n - 1) * (n + 1)) / n;
        for (double cos_in = 1e-2; cos_in > 1e-8; cos_in /= 10) {
            double slope = 2 * (1 / (n * cos_out) + n / cos_out);
            double transmitted = 1 - reflectance_at(n, true, cos_in);
            assert_true(fabs(transmitted - slope * cos_in) <=
                        10 * cos_in * cos_in * slope * slope + 8 * half_ulp);
        }
        assert_relative(reflectance_at(n, true, 0), 1, 8);
    }
}

static void test_no_surface(void **state)
{
    (void)state;
    struct random random = {.state = 1};
    for (int i = 0; i < CASES; ++i) {
        double cos_in =
            random_bool(&random) ? random_scale(&random, 1e-12, 1) : random_between(&random, 0, 1);
        struct refraction refraction = refract_at(pack_glass(1, random_bool(&random)), cos_in);
        assert_false(refraction.total);
        assert_true(refraction.reflectance == 0);
        assert_true(fabs((double)refraction.direction.z + cos_in) <= 2 * half_ulp);
    }
}

/* Fresnel's equations as in the textbook, in double, on the packed numbers. */
static bool textbook(struct packed_glass glass, double cos_in, double *k_r, double *cos_out)
{
    double eta = (double)glass.eta, squared = (double)glass.kappa + eta * eta * cos_in * cos_in;
    if (!(squared > 0))
        return false;
    *cos_out = sqrt(squared);
    double r_s = (eta * cos_in - *cos_out) / (eta * cos_in + *cos_out);
    double r_p = (cos_in - eta * *cos_out) / (cos_in + eta * *cos_out);
    *k_r = (r_s * r_s + r_p * r_p) / 2;
    return true;
}

/* k_r is in [0, 1] but for rounding, it is the textbook's, k_t = 1 - k_r is what crosses the surface, and the
 * two add to exactly 1. */
static void test_energy(void **state)
{
    (void)state;
    struct random random = {.state = 2};
    double worst = 0;
    for (int i = 0; i < CASES; ++i) {
        double ior = random_scale(&random, 0.3, 4);
        struct packed_glass glass = pack_glass(ior, random_bool(&random));
        double cos_in = (double)(float)random_between(&random, 1e-4, 1), right, cos_out;
        struct refraction refraction = refract_at(glass, cos_in);
        if (!textbook(glass, cos_in, &right, &cos_out) || refraction.total)
            continue;
        float k_r = refraction.reflectance, k_t = 1 - k_r;
        assert_true(k_r >= 0 && k_r <= 1 + 8 * (float)half_ulp);
        assert_true(k_r + k_t == 1);
        /* An error of cos_out^2 is a larger one of cos_out, and r_s^2 goes with the fourth power of the sum.
         */
        double eta_cos = (double)glass.eta * cos_in, terms = fabs((double)glass.kappa) + eta_cos * eta_cos;
        double cancelled = terms / (cos_out * fmin(1, eta_cos + cos_out));
        double error = fabs((double)k_r - right) / half_ulp / (8 + 4 * cancelled);
        worst = fmax(worst, error);
    }
    print_message("error of k_r: %.2f of what is allowed\n", worst);
    assert_true(worst <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normal_incidence), cmocka_unit_test(test_brewster),
        cmocka_unit_test(test_critical_angle),   cmocka_unit_test(test_grazing),
        cmocka_unit_test(test_no_surface),       cmocka_unit_test(test_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
