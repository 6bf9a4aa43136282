/* The C reference's float directions against GLM's reflect and refract in double, on a million random pairs
 * of unit vectors. Errors are in units in the last place of 1, 2^-23, a component. */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "dielectric_float.h"

namespace
{

constexpr int pairs = 1000000;
constexpr double ulp = 0x1p-23;

/* 2 cos_in n + d: the cosine, the product and the sum are off by half an ulp of at most 1, 2 and 2 each, as
 * are the inputs of the oracle's unit vectors. */
constexpr double reflect_bound = 2.5;

/* eta d - bend n, where eta, d and bend are off by half an ulp or so of at most 4. */
constexpr double refract_bound = 4;

/* Near the critical angle an error e of cos_out^2 = kappa + eta^2 cos_in^2 is one of e / (2 cos_out) of the
 * direction. In ulp of |kappa| + eta^2 cos_in, e would be 5 if all roundings were largest and of one sign:
 * half of kappa and of eta each, two of cos_in, which counts twice. A million pairs come to 1.4. */
constexpr double cosine_bound = 2;

/* After renormalising, the length's error is what the roundings of the scale and of three products leave. */
constexpr double length_bound = 1.5;

struct worst {
    double reflect = 0;  /* ulp */
    double refract = 0;  /* as a share of what is allowed */
    double critical = 0; /* |cos_out^2| over its two terms where they disagree about total reflection, ulp */
    double length = 0;   /* ulp */
    int total = 0, failures = 0;
};

std::array<float, 3> as_float(const glm::dvec3 &v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

glm::dvec3 unit(const std::array<float, 3> &v)
{
    return glm::normalize(
        glm::dvec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])));
}

double error_ulp(const std::array<float, 3> &found, const glm::dvec3 &right)
{
    double error = 0;
    for (glm::length_t i = 0; i < 3; ++i)
        error = std::max(error, std::abs(static_cast<double>(found[static_cast<std::size_t>(i)]) - right[i]));
    return error / ulp;
}

void fail(worst &worst, const char *what, int pair, double error, double bound)
{
    if (worst.failures++ < 5)
        std::printf("pair %d: %s is off by %g ulp, allowed are %g\n", pair, what, error, bound);
}

/* So that errors do not add up from bounce to bounce. */
void test_length(worst &worst, int pair, const std::array<float, 3> &direction)
{
    double length = std::hypot(static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                               static_cast<double>(direction[2]));
    double error = std::abs(length - 1) / ulp;
    worst.length = std::max(worst.length, error);
    if (!(error <= length_bound))
        fail(worst, "a length", pair, error, length_bound);
}

void test_reflect(worst &worst, int pair, const std::array<float, 3> &direction,
                  const std::array<float, 3> &normal)
{
    std::array<float, 3> reflected;
    reflect_float(direction.data(), normal.data(), reflected.data());
    double error = error_ulp(reflected, glm::reflect(unit(direction), unit(normal)));
    worst.reflect = std::max(worst.reflect, error);
    if (!(error <= reflect_bound))
        fail(worst, "reflect", pair, error, reflect_bound);
    test_length(worst, pair, reflected);
}

void test_refract(worst &worst, int pair, const std::array<float, 3> &direction,
                  const std::array<float, 3> &normal, double ior, bool entering)
{
    std::array<float, 3> refracted{};
    bool passes = refract_float(direction.data(), normal.data(), ior, entering, refracted.data());
    double eta = entering ? 1 / ior : ior;
    glm::dvec3 d = unit(direction), n = unit(normal), right = glm::refract(d, n, eta);
    double cos_in = -glm::dot(d, n);
    double terms = std::abs(1 - eta * eta) + eta * eta * cos_in;
    double cos_out_squared = 1 - eta * eta * (1 - cos_in * cos_in);
    bool right_passes = right != glm::dvec3(0);
    worst.total += !right_passes;
    if (passes != right_passes) {
        double distance = std::abs(cos_out_squared) / (terms * ulp);
        worst.critical = std::max(worst.critical, distance);
        if (!(distance <= cosine_bound))
            fail(worst, "the critical angle", pair, distance, cosine_bound);
    } else if (passes) {
        double bound = refract_bound + cosine_bound * terms / (2 * std::sqrt(cos_out_squared));
        double error = error_ulp(refracted, right);
        worst.refract = std::max(worst.refract, error / bound);
        if (!(error <= bound))
            fail(worst, "refract", pair, error, bound);
        test_length(worst, pair, refracted);
    }
}

} // namespace

int main()
{
    constexpr std::array<double, 8> indices = {1, 1 + 1e-6, 1 - 1e-6, 0.75, 1.3, 1.5, 2.42, 4};
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal_distribution;
    std::uniform_real_distribution<double> uniform;
    auto direction = [&] {
        return glm::normalize(glm::dvec3{normal_distribution(engine), normal_distribution(engine),
                                         normal_distribution(engine)});
    };
    worst worst;
    for (int pair = 0; pair < pairs; ++pair) {
        glm::dvec3 normal = direction(), incident = direction();
        if (glm::dot(normal, incident) > 0)
            normal = -normal;
        bool entering = uniform(engine) < 0.5;
        double ior = uniform(engine) < 0.5 ? indices[static_cast<std::size_t>(uniform(engine) * 8)]
                                           : std::exp2(4 * uniform(engine) - 2);
        double eta = entering ? 1 / ior : ior;
        if (eta > 1 && uniform(engine) < 0.5) { /* about the critical angle */
            double offset = 1e-5 * normal_distribution(engine) * std::pow(uniform(engine), 2);
            double sine = std::min(1.0, (1 + offset) / eta);
            glm::dvec3 tangent = glm::normalize(glm::cross(normal, incident));
            incident = sine * tangent - std::sqrt(1 - sine * sine) * normal;
        }
        test_reflect(worst, pair, as_float(incident), as_float(normal));
        test_refract(worst, pair, as_float(incident), as_float(normal), ior, entering);
    }
    std::printf("%d pairs, %d of total reflection\n", pairs, worst.total);
    std::printf("reflect: within %.2f ulp of 1 (allowed %g)\n", worst.reflect, reflect_bound);
    std::printf("refract: within %.2f of the allowed %g + %g (|kappa| + eta^2 cos_in) / (2 cos_out) ulp\n",
                worst.refract, refract_bound, cosine_bound);
    std::printf("total reflection: cos_out^2 within %.2f ulp of |kappa| + eta^2 cos_in (allowed %g) where "
                "they part\n",
                worst.critical, cosine_bound);
    std::printf("lengths: within %.2f ulp of 1 (allowed %g)\n", worst.length, length_bound);
    return worst.failures > 0;
}
