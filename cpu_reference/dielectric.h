/* Reflection and refraction at the smooth surface of a body of index of refraction ior in vacuum. */
#ifndef REFERENCE_DIELECTRIC_H
#define REFERENCE_DIELECTRIC_H

#include <stdbool.h>

#include "real.h"

/* cos_in = -direction . normal, not below 0; normal faces the ray. */
static inline struct vec3 reflect(struct vec3 direction, struct vec3 normal, real cos_in)
{
    return renormalize(add(direction, scale(2 * cos_in, normal)));
}

struct refraction {
    bool total;            /* total internal reflection; nothing below holds */
    struct vec3 direction; /* of the refracted ray, unit */
    real reflectance;      /* Fresnel's k_r, unpolarised, in [0, 1] */
};

/* Snell's law and Fresnel's equations, eta = n1 / n2 and kappa = 1 - eta^2 given exactly by the scene. As
 * cos_out^2 - (eta cos_in)^2 = kappa, the difference eta cos_in - cos_out, which cancels for ior near 1, is
 * -kappa / (eta cos_in + cos_out), and r_p = r_s cos(i + o) / cos(i - o). */
static inline struct refraction refract(struct vec3 direction, struct vec3 normal, real cos_in, real eta,
                                        real kappa)
{
    struct refraction refraction = {.total = true};
    real eta_cos = eta * cos_in;
    real cos_out_squared = kappa + eta_cos * eta_cos;
    if (!(cos_out_squared > 0))
        return refraction;
    real cos_out = square_root(cos_out_squared);
    real bend = kappa / (eta_cos + cos_out);
    real r_s = bend / (eta_cos + cos_out);
    real cosines = cos_in * cos_out;
    real sines = eta * (1 - cos_in * cos_in);
    real ratio = (cosines - sines) / (cosines + sines);
    refraction.total = false;
    refraction.direction = renormalize(subtract(scale(eta, direction), scale(bend, normal)));
    refraction.reflectance = (real)0.5 * (r_s * r_s) * (1 + ratio * ratio);
    return refraction;
}

#endif
