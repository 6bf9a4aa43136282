/* Giants: spheres so large beside where the camera is that float has no digits of a place there relative to
 * their centre. They are stored and met as planes that curve; scene_layout.h says how. */
#ifndef REFERENCE_GIANT_H
#define REFERENCE_GIANT_H

#include <stdbool.h>

#include "packed_scene.h"
#include "real.h"

struct giant {
    struct vec3 gradient; /* of the height, at the origin of coordinates */
    real offset;          /* minus the height there */
    real curvature;       /* 1 / radius */
};

static inline struct giant giant_of(const struct packed_scene *scene, int surface)
{
    layout_vec4 shape = scene->spheres[surface].center_radius;
    return (struct giant){vector_of(shape), shape.w, scene->surfaces[surface].more_parameters.CURVATURE};
}

/* (|point - centre|^2 - radius^2) / (2 radius): near the surface the distance from it, negative inside. */
static inline real giant_height(const struct giant *giant, struct vec3 point)
{
    return dot(add(giant->gradient, scale(giant->curvature / 2, point)), point) - giant->offset;
}

/* The height's, of length 1 on the surface, where it is the normal. */
static inline struct vec3 giant_gradient(const struct giant *giant, struct vec3 point)
{
    return add(giant->gradient, scale(giant->curvature, point));
}

/* Along a line from its origin the height is height + slope t + curvature / 2 t^2. */
struct giant_line {
    real height, slope;
    real root_squared; /* the square of the slope where the line meets the surface; negative: it misses */
};

static inline struct giant_line giant_line(const struct giant *giant, struct vec3 origin,
                                           struct vec3 direction, bool may_be_inside)
{
    struct giant_line line;
    real height = giant_height(giant, origin);
    line.height = may_be_inside ? height : at_least_zero(height);
    line.slope = dot(giant_gradient(giant, origin), direction);
    line.root_squared = line.slope * line.slope - giant->curvature * (2 * line.height);
    return line;
}

/* Whether the line goes through the surface; grazing it at less of a slope than 2^-50, where squares become
 * denormal, it does not. */
static inline bool giant_is_crossed(const struct giant_line *line)
{
    return line->root_squared > (real)PARALLEL;
}

static inline real giant_root(const struct giant_line *line)
{
    return giant_is_crossed(line) ? square_root(line->root_squared) : 0;
}

#endif
