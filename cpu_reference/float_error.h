/* What float loses: the units of the error analysis in margin.h. */
#ifndef REFERENCE_FLOAT_ERROR_H
#define REFERENCE_FLOAT_ERROR_H

#include "real.h"

static const double unit_roundoff = 0x1p-24; /* float's */

/* What a few operations on quantities of this size lose: the vector formulas here take 4 to 8 roundings of
 * half a unit each. */
static inline double rounding(double magnitude)
{
    return 3 * unit_roundoff * magnitude;
}

static inline double length(struct vec3 v)
{
    return (double)square_root(dot(v, v));
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

struct ray_error {
    double origin;    /* length */
    double direction; /* radians */
};

#endif
