#include "bench/pareto.h"

#include <math.h>

void pareto_front(const double *times, const double *errors, size_t count, bool *front)
{
    for (size_t i = 0; i < count; ++i) {
        front[i] = isfinite(errors[i]);
        for (size_t k = 0; k < count && front[i]; ++k)
            if (times[k] <= times[i] && errors[k] <= errors[i] &&
                (times[k] < times[i] || errors[k] < errors[i]))
                front[i] = false;
    }
}

size_t fastest_within(const double *times, const double *errors, size_t count, double within)
{
    size_t best = count;
    for (size_t i = 0; i < count; ++i)
        if (errors[i] <= within && (best == count || times[i] < times[best]))
            best = i;
    return best;
}
