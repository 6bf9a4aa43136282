#ifndef VKWHITTED_BASE_STATISTICS_H
#define VKWHITTED_BASE_STATISTICS_H

#include <stddef.h>

/* In ascending order. */
void sort_doubles(double *values, size_t count);

/* The quantile of ascending values, from 0 (the least) to 1, linear between neighbours; 0 where there is
 * none. */
double sorted_quantile(const double *sorted, size_t count, double fraction);

/* Slope of the least-squares line through (log x, log y); pairs that are not both finite and above 0 do not
 * count. NaN where fewer than three count or all have one x. */
double log_log_slope(const double *x, const double *y, size_t count);

#endif
