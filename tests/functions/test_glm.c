/* The C reference's float directions against GLM's reflect and refract in double, on a million random pairs
 * of unit vectors. Errors are in units in the last place of 1, 2^-23, a component. */
#include "../cmocka_test.h"

#include "dielectric.h"
#include "glm_oracle.h"
#include "packed_glass.h"
#include "random.h"

enum { PAIRS = 1000000 };
static const double ulp = 0x1p-23;

/* 2 cos_in n + d: the cosine, the product and the sum are off by half an ulp of at most 1, 2 and 2 each, as
 * are the inputs of the oracle's unit vectors. */
static const double reflect_bound = 2.5;

/* eta d - bend n, where eta, d and bend are off by half an ulp or so of at most 4. */
static const double refract_bound = 4;

/* Near the critical angle an error e of cos_out^2 = kappa + eta^2 cos_in^2 is one of e / (2 cos_out) of the
 * direction. In ulp of |kappa| + eta^2 cos_in, e would be 5 if all roundings were largest and of one sign:
 * half of kappa and of eta each, two of cos_in, which counts twice. A million pairs come to 1.6. */
static const double cosine_bound = 2;

/* After renormalising, the length's error is what the roundings of the scale and of three products leave, so
 * that errors do not add up from bounce to bounce. */
static const double length_bound = 1.5;

struct pair {
    struct vec3 direction, normal;
    struct dvec3 d, n; /* the same in double, of length 1 */
    double ior, eta;
    bool entering;
};

static struct pair random_pair(struct random *random)
{
    static const double indices[] = {1, 1 + 1e-6, 1 - 1e-6, 0.75, 1.3, 1.5, 2.42, 4};
    struct dvec3 normal = random_direction(random), incident = random_direction(random);
    if (dvec3_dot(normal, incident) > 0)
        normal = dvec3_scale(-1, normal);
    struct pair pair = {.entering = random_bool(random), .ior = indices[random_below(random, 8)]};
    if (random_bool(random))
        pair.ior = random_scale(random, 0.25, 4);
    pair.eta = pair.entering ? 1 / pair.ior : pair.ior;
    if (pair.eta > 1 && random_bool(random)) { /* about the critical angle */
        double offset = random_signed(random, 1e-12, 3e-5);
        double sine = fmin(1, (1 + offset) / pair.eta);
        struct dvec3 tangent = dvec3_unit(dvec3_cross(normal, incident));
        incident = dvec3_along(dvec3_scale(sine, tangent), -sqrt(1 - sine * sine), normal);
    }
    pair.direction = round_vector(incident);
    pair.normal = round_vector(normal);
    pair.d = dvec3_unit(widen(pair.direction));
    pair.n = dvec3_unit(widen(pair.normal));
    return pair;
}

static struct oracle_vector for_oracle(struct dvec3 v)
{
    return (struct oracle_vector){v.x, v.y, v.z};
}

/* Fails where the error is above the bound, and keeps the largest. */
static void hold(double *worst, const char *what, const struct pair *pair, double error, double bound)
{
    if (!(error <= bound))
        fail_msg("%s is off by %g ulp, allowed are %g: direction %a %a %a, normal %a %a %a, ior %a, %s", what,
                 error, bound, (double)pair->direction.x, (double)pair->direction.y,
                 (double)pair->direction.z, (double)pair->normal.x, (double)pair->normal.y,
                 (double)pair->normal.z, pair->ior, pair->entering ? "entering" : "exiting");
    *worst = fmax(*worst, error);
}

static double error_ulp(struct vec3 found, struct oracle_vector right)
{
    return fmax(fabs((double)found.x - right.x),
                fmax(fabs((double)found.y - right.y), fabs((double)found.z - right.z))) /
           ulp;
}

static double length_error(struct vec3 direction)
{
    return fabs(dvec3_length(widen(direction)) - 1) / ulp;
}

static void test_reflect(void **state)
{
    (void)state;
    double worst = 0, worst_length = 0;
    for (uint64_t i = 0; i < PAIRS; ++i) {
        struct random random = random_start(1, 0, i);
        struct pair pair = random_pair(&random);
        struct oracle_vector right = oracle_reflect(for_oracle(pair.d), for_oracle(pair.n));
        struct vec3 found =
            reflect(pair.direction, pair.normal, at_least_zero(-dot(pair.normal, pair.direction)));
        hold(&worst, "reflect", &pair, error_ulp(found, right), reflect_bound);
        hold(&worst_length, "a length", &pair, length_error(found), length_bound);
    }
    print_message("within %.2f ulp of 1 (allowed %g), lengths %.2f (%g)\n", worst, reflect_bound,
                  worst_length, length_bound);
}

static void test_refract(void **state)
{
    (void)state;
    double worst = 0, worst_length = 0, worst_critical = 0; /* worst: as a share of what is allowed */
    int total = 0;
    for (uint64_t i = 0; i < PAIRS; ++i) {
        struct random random = random_start(2, 0, i);
        struct pair pair = random_pair(&random);
        struct packed_glass glass = pack_glass(pair.ior, pair.entering);
        struct refraction found =
            refract(pair.direction, pair.normal, at_least_zero(-dot(pair.normal, pair.direction)), glass.eta,
                    glass.kappa);
        double eta = pair.eta;
        struct oracle_vector right = oracle_refract(for_oracle(pair.d), for_oracle(pair.n), eta);
        bool right_total = right.x == 0 && right.y == 0 && right.z == 0;
        double cos_in = -dvec3_dot(pair.d, pair.n);
        double terms = fabs(1 - eta * eta) + eta * eta * cos_in;
        double cos_out_squared = 1 - eta * eta * (1 - cos_in * cos_in);
        total += right_total;
        if (found.total != right_total) {
            hold(&worst_critical, "the critical angle", &pair, fabs(cos_out_squared) / (terms * ulp),
                 cosine_bound);
        } else if (!found.total) {
            double bound = refract_bound + cosine_bound * terms / (2 * sqrt(cos_out_squared));
            hold(&worst, "refract, as a share of what is allowed,", &pair,
                 error_ulp(found.direction, right) / bound, 1);
            hold(&worst_length, "a length", &pair, length_error(found.direction), length_bound);
        }
    }
    print_message(
        "%d of total reflection; within %.2f of what is allowed, lengths within %.2f ulp (%g); where they "
        "part, cos_out^2 within %.2f ulp (%g)\n",
        total, worst, worst_length, length_bound, worst_critical, cosine_bound);
    assert_in_range(total, PAIRS / 20, PAIRS / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_reflect), cmocka_unit_test(test_refract)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
