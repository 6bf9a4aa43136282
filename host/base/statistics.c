#include "base/statistics.h"

#include <math.h>
#include <stdlib.h>

static int compare_doubles(const void *a, const void *b)
{
    double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

void sort_doubles(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
}

double sorted_quantile(const double *sorted, size_t count, double fraction)
{
    if (count == 0)
        return 0;
    double place = fraction * (double)(count - 1);
    size_t below = (size_t)place;
    double share = place - (double)below;
    return share > 0 ? sorted[below] + share * (sorted[below + 1] - sorted[below]) : sorted[below];
}

double log_log_slope(const double *x, const double *y, size_t count)
{
    double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, used = 0;
    for (size_t i = 0; i < count; ++i) {
        double log_x = log(x[i]), log_y = log(y[i]);
        if (!isfinite(log_x) || !isfinite(log_y))
            continue;
        sum_x += log_x;
        sum_y += log_y;
        sum_xx += log_x * log_x;
        sum_xy += log_x * log_y;
        ++used;
    }
    double spread = used * sum_xx - sum_x * sum_x;
    return used < 3 || !(spread > 0) ? NAN : (used * sum_xy - sum_x * sum_y) / spread;
}
