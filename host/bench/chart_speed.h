#ifndef VKWHITTED_BENCH_CHART_SPEED_H
#define VKWHITTED_BENCH_CHART_SPEED_H

#include <jansson.h>

#include "bench/chart_frame.h"

/* Draws the points of a scene of the bench document, time against RMSE, both logarithmic, with the Pareto
 * fronts, as one <svg> element. Each point shows on hover what it is; unless the frame stands alone, it links
 * to the element with the id ROW_PREFIX and the point's index. STATUS_UNABLE has been reported. */
enum status chart_speed(const json_t *scene, const struct chart_frame *frame, const char *row_prefix,
                        FILE *out);

#endif
