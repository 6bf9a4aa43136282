#ifndef VKWHITTED_BENCH_PARETO_H
#define VKWHITTED_BENCH_PARETO_H

#include <stdbool.h>
#include <stddef.h>

/* Marks the points that no other beats: none takes no more time with no more error, and less of one. A point
 * whose error is not finite is never marked. */
void pareto_front(const double *times, const double *errors, size_t count, bool *front);

/* The index of the least time among the points with an error of at most `within`; count if there is none. */
size_t fastest_within(const double *times, const double *errors, size_t count, double within);

#endif
