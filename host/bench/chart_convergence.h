#ifndef VKWHITTED_BENCH_CHART_CONVERGENCE_H
#define VKWHITTED_BENCH_CHART_CONVERGENCE_H

#include <jansson.h>

#include "bench/chart_frame.h"

/* Draws one entry of a scene's "convergence" in the bench document: RMSE against the number of samples N, the
 * line with the fitted slope, and one with that of independent random points, N^-1/2, as one <svg> element.
 * STATUS_UNABLE has been reported. */
enum status chart_convergence(const json_t *convergence, const struct chart_frame *frame, FILE *out);

#endif
