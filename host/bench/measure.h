#ifndef VKWHITTED_BENCH_MEASURE_H
#define VKWHITTED_BENCH_MEASURE_H

#include "bench/ground_truth.h"
#include "bench/settings.h"

enum { BENCH_MAX_RUNS = 51 };

/* A setting and what was measured of it. */
struct bench_point {
    struct bench_setting setting;
    struct packed_scene packed;
    struct tracer *tracer; /* on a device, ready to render */
    double setup_ms, first_ms;
    double runs_ms[BENCH_MAX_RUNS]; /* of the warm runs; ascending after bench_run_rounds() */
    size_t run_count;
    double spent_ms;
    double median_ms, quartiles_ms[2];
    struct reference_rays rays;
    struct bench_error error;
    bool pareto;
};

/* Until when to go on. */
struct run_limits {
    size_t least_runs, most_runs; /* of a point */
    double point_ms;              /* of a point, but for its least runs */
    double all_ms;                /* of all points, but for their least runs */
};

/* Readies the point for rendering and renders it once into *image, which is made anew, with room for double
 * precision where that is asked for. On failure (reported) the point holds nothing. */
enum status bench_point_start(struct vulkan_context *context, const struct scene *scene,
                              struct bench_point *point, struct image *image);

/* Renders a started point once more; on the CPU its picture replaces the image's. */
enum status bench_point_run(struct bench_point *point, struct image *image, double *milliseconds);
void bench_point_destroy(struct bench_point *point);

/* Runs all points warm in rounds, one run of each in a round, so that what disturbs the machine for a while
 * disturbs all of them; the CPU's points stand between the device's, and every other round runs backward, so
 * that a steady drift cancels. Advances progress by `share`. */
enum status bench_run_rounds(struct bench_point *points, size_t count, const struct run_limits *limits,
                             struct image *image, struct progress *progress, double share);

/* Counts the rays of the points on a device, as they are in float, with another pipeline. Points that make
 * the same picture share them, also those that the CPU has counted as it rendered. */
enum status bench_count_rays(struct vulkan_context *context, struct bench_point *points, size_t count);

#endif
