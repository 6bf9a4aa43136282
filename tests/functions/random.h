#ifndef RANDOM_H
#define RANDOM_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "real.h"
#include "scene/vector.h"

/* What the drawn scenes do not hold, so that a pipeline specialised to such scenes can be tested on them. */
struct promises {
    bool giant;         /* spheres are giants */
    bool never_entered; /* rays, shading points and lights are outside of spheres */
    bool opaque_planes; /* no plane is transparent */
    int axis;           /* planes' normals are along x 1, y 2, z 3, anything 0 */
    bool lambert;       /* no matte is rough */
    bool in_order;      /* spheres stand before planes in the scene file */
};

/* Random numbers of one case: SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), started anew for every case,
 * so that a case can be had alone. No two of these calls stand in one argument list or initialiser, whose
 * order of evaluation C leaves open: every compiler makes the same cases. */
struct random {
    uint64_t state;
    struct promises promises;
};

static inline uint64_t random_bits(struct random *random)
{
    uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static inline struct random random_start(uint64_t seed, uint64_t stream, uint64_t index)
{
    struct random random = {.state = seed};
    random.state = random_bits(&random) ^ stream;
    random.state = random_bits(&random) ^ index;
    random.state = random_bits(&random);
    return random;
}

static inline unsigned random_below(struct random *random, unsigned count)
{
    return (unsigned)((random_bits(random) >> 32) * count >> 32);
}

static inline bool random_bool(struct random *random)
{
    return random_bits(random) >> 63;
}

static inline double random_between(struct random *random, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(random) >> 11) * 0x1p-53);
}

/* Log-uniform. */
static inline double random_scale(struct random *random, double low, double high)
{
    return exp2(random_between(random, log2(low), log2(high)));
}

static inline bool one_in(struct random *random, unsigned count)
{
    return random_below(random, count) == 0;
}

static inline double random_sign(struct random *random)
{
    return random_bool(random) ? 1 : -1;
}

/* Log-uniform, of either sign. */
static inline double random_signed(struct random *random, double low, double high)
{
    double sign = random_sign(random);
    return sign * random_scale(random, low, high);
}

/* In the cube that scenes fill, in scene units. */
static inline struct dvec3 random_point(struct random *random)
{
    double x = random_between(random, -1, 1);
    double y = random_between(random, -1, 1);
    return (struct dvec3){x, y, random_between(random, -1, 1)};
}

/* Uniform on the unit sphere. */
static inline struct dvec3 random_direction(struct random *random)
{
    struct dvec3 point;
    double squared;
    do {
        point = random_point(random);
        squared = dvec3_dot(point, point);
    } while (squared > 1 || squared < 1e-6);
    return dvec3_scale(1 / sqrt(squared), point);
}

/* Along a random axis. */
static inline struct dvec3 random_axis(struct random *random)
{
    unsigned axis = random_below(random, 3);
    double sign = random_sign(random);
    return (struct dvec3){axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
}

/* A unit vector perpendicular to the unit vector `normal`. */
static inline struct dvec3 random_tangent(struct random *random, struct dvec3 normal)
{
    struct dvec3 tangent;
    do
        tangent = dvec3_cross(normal, random_direction(random));
    while (dvec3_dot(tangent, tangent) < 1e-6);
    return dvec3_unit(tangent);
}

/* From start, `distance` along direction. */
static inline struct dvec3 dvec3_along(struct dvec3 start, double distance, struct dvec3 direction)
{
    return dvec3_add(start, dvec3_scale(distance, direction));
}

/* From start so far in a random direction. */
static inline struct dvec3 random_away(struct random *random, struct dvec3 start, double distance)
{
    return dvec3_along(start, distance, random_direction(random));
}

/* From start so far in a random direction perpendicular to the unit vector `normal`. */
static inline struct dvec3 random_aside(struct random *random, struct dvec3 normal, struct dvec3 start,
                                        double distance)
{
    return dvec3_along(start, distance, random_tangent(random, normal));
}

/* To float, without denormals, as the packer does it. */
static inline float round_number(double x)
{
    return fabs(x) < (double)FLT_MIN ? 0 : (float)x;
}

static inline struct vec3 round_vector(struct dvec3 v)
{
    return (struct vec3){round_number(v.x), round_number(v.y), round_number(v.z)};
}

static inline struct dvec3 widen(struct vec3 v)
{
    return (struct dvec3){(double)v.x, (double)v.y, (double)v.z};
}

/* x or one of the few floats beside it. */
static inline float random_neighbour(struct random *random, float x)
{
    for (unsigned steps = random_below(random, 4); steps > 0; --steps)
        x = nextafterf(x, random_bool(random) ? INFINITY : -INFINITY);
    return fabsf(x) < FLT_MIN ? 0 : x;
}

#endif
