#include "scene/giant.h"

/* In scene units. A larger ball is stored as one of this radius, with the same surface at the origin: its
 * horizon, seen from height h, is lower by sqrt(2 h / r) or less, 2^-15.5 radians. Of still larger ones,
 * doubles would not tell on which side of the surface the camera is. */
static const double largest_radius = 0x1p32;

struct giant_shape giant_shape_of(struct body giant)
{
    const double height = giant_height(giant), curvature = 1 / fmin(giant.number, largest_radius);
    return (struct giant_shape){
        .gradient = dvec3_scale(-(1 - curvature * height), dvec3_unit(giant.vector)),
        .offset = height * (1 - curvature * height / 2),
        .curvature = curvature,
    };
}
