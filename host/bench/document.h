#ifndef VKWHITTED_BENCH_DOCUMENT_H
#define VKWHITTED_BENCH_DOCUMENT_H

#include <jansson.h>

#include "bench/measure.h"
#include "check/compare.h"
#include "check/judge.h"

/* Everything that a bench has found out about a scene. */
struct bench_result {
    const char *path;
    struct picture_settings picture; /* the scene's */
    struct bench_point *points;
    size_t count;
    const struct ground_truth *truth, *filtered; /* for all families but samples; for those */
    bool has_agreement;
    struct comparison agreement; /* of the device with the reference */
    struct judgement rounding;   /* of float against quad */
    size_t rounding_pixels;
    bool meters_device; /* joules are the device's, too */
};

/* Marks the points that nothing with the same truth beats in both time and error. The error is that
 * which 99.9 % of the pixels are within: of a picture with few ill-conditioned pixels (light that just grazes
 * an edge), RMSE tells only of those. */
void bench_mark_pareto(struct bench_point *points, size_t count);

/* The document's head, with the command line, its list of scenes empty. NULL without memory, as below. */
json_t *bench_document(int argc, char **argv, bool quick, const struct vulkan_context *context);

/* A scene of the document. */
json_t *bench_scene_document(const struct bench_result *result);

#endif
