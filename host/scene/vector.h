#ifndef VKWHITTED_SCENE_VECTOR_H
#define VKWHITTED_SCENE_VECTOR_H

#include <math.h>

#include "scene_layout.h"

/* Vectors of three doubles for preparing the scene; cglm has float only. */
struct dvec3 {
    double x, y, z;
};

static inline struct dvec3 dvec3_of(const double v[3])
{
    return (struct dvec3){v[0], v[1], v[2]};
}

/* Without w. */
static inline struct dvec3 dvec3_of_vec4(layout_vec4 v)
{
    return (struct dvec3){(double)v.x, (double)v.y, (double)v.z};
}

static inline struct dvec3 dvec3_add(struct dvec3 a, struct dvec3 b)
{
    return (struct dvec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct dvec3 dvec3_scale(double s, struct dvec3 v)
{
    return (struct dvec3){s * v.x, s * v.y, s * v.z};
}

static inline struct dvec3 dvec3_subtract(struct dvec3 a, struct dvec3 b)
{
    return (struct dvec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double dvec3_dot(struct dvec3 a, struct dvec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct dvec3 dvec3_cross(struct dvec3 a, struct dvec3 b)
{
    return (struct dvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double dvec3_largest(struct dvec3 v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

/* v times the power of two that brings it near 1, where squares neither over- nor underflow. */
static inline struct dvec3 dvec3_near_one(struct dvec3 v, int *exponent)
{
    frexp(dvec3_largest(v), exponent);
    return (struct dvec3){ldexp(v.x, -*exponent), ldexp(v.y, -*exponent), ldexp(v.z, -*exponent)};
}

static inline double dvec3_length(struct dvec3 v)
{
    int exponent;
    struct dvec3 near_one = dvec3_near_one(v, &exponent);
    return ldexp(sqrt(dvec3_dot(near_one, near_one)), exponent);
}

static inline double dvec3_distance(struct dvec3 a, struct dvec3 b)
{
    return dvec3_length(dvec3_subtract(a, b));
}

static inline struct dvec3 dvec3_unit(struct dvec3 v)
{
    int exponent;
    struct dvec3 near_one = dvec3_near_one(v, &exponent);
    return dvec3_scale(1 / sqrt(dvec3_dot(near_one, near_one)), near_one);
}

/* One of the four corners of the parallelogram with edges u and v at corner 0; they are numbered row by row.
 */
static inline struct dvec3 dvec3_corner(struct dvec3 corner, struct dvec3 u, struct dvec3 v, int number)
{
    return dvec3_add(corner, dvec3_add(dvec3_scale(number & 1, u), dvec3_scale(number >> 1, v)));
}

#endif
