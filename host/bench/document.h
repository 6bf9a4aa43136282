#ifndef VKWHITTED_BENCH_DOCUMENT_H
#define VKWHITTED_BENCH_DOCUMENT_H

#include <jansson.h>

#include "bench/measure.h"
#include "check/judge.h"

/* Everything that a bench has found out about a scene. */
struct bench_result {
    const char *path;
    struct picture_settings picture; /* the scene's */
    struct bench_point *points;
    size_t count;
    struct ground_truth truth, filtered; /* for all families but samples; for those */
    bool sampled;                        /* the scene's lights are */
    bool has_agreement;
    size_t differing;          /* pixels, in bits, on the device and of the reference */
    struct judgement rounding; /* of float against quad */
    size_t rounding_pixels;
};

/* Marks those of the points with the same truth that none beats: none takes no more time with no more error,
 * and less of one. The error is that which 99.9 % of the pixels are within: of a picture with few
 * ill-conditioned pixels (light that just grazes an edge), RMSE tells only of those. A point whose error is
 * not finite is never marked. */
void bench_mark_pareto(struct bench_point *points, size_t count);

/* The point of the least time with an error of at most `within`, those of pixel samples apart; NULL: none. */
const struct bench_point *bench_fastest_within(const struct bench_point *points, size_t count, double within);

/* The document's head, with the command line, its list of scenes empty. NULL without memory, as below. */
json_t *bench_document(int argc, char **argv, bool quick, const struct vulkan_context *context);

/* A scene of the document. */
json_t *bench_scene_document(const struct bench_result *result);

/* A number of the document: infinite where it is null, which stands for what is not finite, or missing. */
double bench_number(const json_t *object, const char *key);

/* A text of the document; "" where it is missing. */
const char *bench_text(const json_t *object, const char *key);

/* Whether the point's errors are against the truth for pixel samples. */
bool bench_is_filtered(const json_t *point);

#endif
