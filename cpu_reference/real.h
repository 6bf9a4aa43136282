/* The number type that a build of the reference computes with, chosen by REFERENCE_BITS, and vectors of it.
 * Each operation is rounded once, to nearest, in the order written. */
#ifndef REFERENCE_REAL_H
#define REFERENCE_REAL_H

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "scene_layout.h"

#if FLT_EVAL_METHOD != 0
#error "the reference needs float arithmetic in float (FLT_EVAL_METHOD 0)"
#endif

#if REFERENCE_BITS == 32
typedef float real;
#define square_root sqrtf
#elif REFERENCE_BITS == 64
typedef double real;
#define square_root sqrt
#elif REFERENCE_BITS == 128 && LDBL_MANT_DIG == 113 /* aarch64 */
typedef long double real;
#define square_root sqrtl
#elif REFERENCE_BITS == 128 /* x86-64: glibc has the function, clang's headers do not declare it */
__extension__ typedef __float128 real;
extern real sqrtf128(real);
#define square_root sqrtf128
#else
#error "REFERENCE_BITS must be 32, 64 or 128"
#endif

struct vec3 {
    real x, y, z;
};

static inline struct vec3 vector_of(layout_vec4 v)
{
    return (struct vec3){v.x, v.y, v.z};
}

static inline struct vec3 add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 subtract(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 multiply(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline struct vec3 scale(real s, struct vec3 v)
{
    return (struct vec3){s * v.x, s * v.y, s * v.z};
}

static inline struct vec3 negate(struct vec3 v)
{
    return (struct vec3){-v.x, -v.y, -v.z};
}

static inline real dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 normalize(struct vec3 v)
{
    return scale(1 / square_root(dot(v, v)), v);
}

/* v is a unit vector but for what float's rounding makes of the scene's normals and indices of refraction:
 * one Newton step towards length 1, which leaves 3/2 of that error's square. That is below double's rounding,
 * and not below binary128's. */
static inline struct vec3 renormalize(struct vec3 v)
{
#if REFERENCE_BITS == 128
    return normalize(v);
#else
    return scale((real)1.5 - (real)0.5 * dot(v, v), v);
#endif
}

static inline real absolute(real x)
{
    return x < 0 ? -x : x;
}

static inline real at_least_zero(real x)
{
    return x > 0 ? x : 0;
}

#endif
