/* Running error analysis of giants; see margin.h, and "Giants" in NUMERICS.md. */
#ifndef REFERENCE_GIANT_MARGIN_H
#define REFERENCE_GIANT_MARGIN_H

#include "float_error.h"
#include "giant.h"

/* No gradient on the way to the point is longer. */
static inline double longest_gradient(const struct giant *giant, struct vec3 point)
{
    return length(giant->gradient) + (double)giant->curvature * length(point);
}

static inline double height_error(const struct giant *giant, struct vec3 point, double e_point)
{
    double steepest = longest_gradient(giant, point);
    return e_point * steepest + rounding(fabs((double)giant->offset) + length(point) * steepest);
}

/* As giant_line(), with errors. */
struct tracked_giant_line {
    double height, e_height, slope, e_slope;
    double root_squared, e_root_squared;
    double root, e_root;
};

static inline struct tracked_giant_line track_giant_line(const struct giant *giant, struct vec3 origin,
                                                         struct vec3 direction, struct ray_error error,
                                                         bool may_be_inside)
{
    struct giant_line line = giant_line(giant, origin, direction, may_be_inside);
    double steepest = longest_gradient(giant, origin), curvature = (double)giant->curvature;
    struct tracked_giant_line tracked = {
        .height = (double)line.height,
        .e_height = height_error(giant, origin, error.origin),
        .slope = (double)line.slope,
        .e_slope = error.direction * steepest + curvature * error.origin + rounding(steepest),
        .root_squared = (double)line.root_squared,
        .root = (double)giant_root(&line),
    };
    double e_squared = (2 * fabs(tracked.slope) + tracked.e_slope) * tracked.e_slope +
                       2 * curvature * tracked.e_height +
                       rounding(tracked.slope * tracked.slope + 2 * curvature * fabs(tracked.height));
    tracked.e_root_squared = e_squared;
    tracked.e_root = smaller(e_squared / tracked.root, sqrt(e_squared));
    return tracked;
}

/* Error of the distance to where the line meets the giant: from outside, where it is 2 height / (root -
 * slope); from inside; or along a chord. Where the line is certain to meet it, e_slope + e_root is at most
 * 3/4 of root - slope. */
static inline double giant_distance_error(const struct giant *giant, const struct tracked_giant_line *line,
                                          bool chord, double distance)
{
    double curvature = (double)giant->curvature, e_divisor = line->e_slope + line->e_root;
    if (chord)
        return 2 * line->e_slope / curvature + rounding(distance);
    if (line->height < 0 && line->slope <= 0)
        return e_divisor / curvature + rounding(distance);
    double divisor = fabs(line->slope) + line->root;
    return (2 * line->e_height + distance * e_divisor) / larger(divisor - e_divisor, divisor / 4) +
           rounding(distance);
}

#endif
