#ifndef PACKED_GLASS_H
#define PACKED_GLASS_H

#include <stdbool.h>

/* What host/pack.c gives of an index of refraction. */
struct packed_glass {
    float eta, kappa; /* n1 / n2 and 1 - eta^2 */
};

static inline struct packed_glass pack_glass(double ior, bool entering)
{
    if (entering)
        return (struct packed_glass){(float)(1 / ior), (float)((ior - 1) * (ior + 1) / (ior * ior))};
    return (struct packed_glass){(float)ior, (float)((1 - ior) * (1 + ior))};
}

#endif
