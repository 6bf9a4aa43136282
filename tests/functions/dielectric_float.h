/* cpu_reference/dielectric.h at float, for C++. */
#ifndef DIELECTRIC_FLOAT_H
#define DIELECTRIC_FLOAT_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

void reflect_float(const float direction[3], const float normal[3], float reflected[3]);

/* Into the body of this index of refraction or out of it. False: total internal reflection. */
bool refract_float(const float direction[3], const float normal[3], double ior, bool entering,
                   float refracted[3]);

#ifdef __cplusplus
}
#endif

#endif
