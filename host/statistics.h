#ifndef VKWHITTED_STATISTICS_H
#define VKWHITTED_STATISTICS_H

#include <stddef.h>

/* In ascending order. */
void sort_doubles(double *values, size_t count);

#endif
