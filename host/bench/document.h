#ifndef VKWHITTED_BENCH_DOCUMENT_H
#define VKWHITTED_BENCH_DOCUMENT_H

#include "bench/measure.h"

/* Marks those of the points with the same truth that none beats: none takes no more time with no more error,
 * and less of one. The error is that which 99.9 % of the pixels are within: of a picture with few
 * ill-conditioned pixels (light that just grazes an edge), RMSE tells only of those. A point whose error is
 * not finite is never marked. */
void bench_mark_pareto(struct bench_point *points, size_t count);

/* The point of the least time with an error of at most `within`, those of pixel samples apart; NULL: none. */
const struct bench_point *bench_fastest_within(const struct bench_point *points, size_t count, double within);

/* Marks the finished bench's points, and describes it as a scene of the document. STATUS_UNABLE (reported)
 * without memory or where its path is not UTF-8. */
enum status bench_describe(struct bench *bench, json_t **scene);

/* A number of the document: infinite where it is null, which stands for what is not finite, or missing. */
double bench_number(const json_t *object, const char *key);

/* A text of the document; "" where it is missing. */
const char *bench_text(const json_t *object, const char *key);

/* The distance of the quartiles of the point's times. */
double bench_spread_ms(const json_t *point);

/* Whether the point's errors are against the truth for pixel samples. */
bool bench_is_filtered(const json_t *point);

#endif
