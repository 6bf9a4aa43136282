#include "bench/measure.h"

#include <math.h>

#include "base/clock.h"
#include "base/statistics.h"

/* Renders a started point; on the CPU its picture replaces the image's. */
static enum status run_point(struct bench_point *point, struct image *image, double *milliseconds)
{
    if (point->tracer) {
        struct progress unseen;
        progress_start(&unseen, "", 1, true);
        struct tracer_times times;
        enum status traced = render_once_on_device(point->tracer, &point->plan, image, &unseen, &times);
        *milliseconds = times.dispatch_ms;
        return traced;
    }
    struct rendering rendering;
    enum status status = render_on_cpu(&point->plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    *milliseconds = rendering.first_dispatch_ms;
    point->rays = rendering.rays;
    image_destroy(image);
    *image = rendering.image;
    return STATUS_DONE;
}

static void stop_point(struct bench_point *point)
{
    tracer_destroy(&point->tracer);
    pack_destroy(&point->packed);
}

/* Readies the point for rendering, renders it once into the bench's image, which is made anew, and counts its
 * rays. On failure (reported) the point holds nothing. */
static enum status start_point(struct bench *bench, struct bench_point *point)
{
    const struct picture_settings *picture = &point->picture;
    bool is_double = point->plan.precision == PRECISION_DOUBLE, on_device = point->backend == BACKEND_VULKAN;
    point->plan.scene = &point->packed;
    point->plan.window = (struct window){0, 0, picture->width, picture->height};
    point->plan.quiet = true;
    point->plan.shaders = bench->job.plan.shaders;
    image_destroy(&bench->image);
    enum status status = image_create(picture->width, picture->height, &bench->image);
    if (status == STATUS_DONE && on_device && is_double)
        status = image_widen(&bench->image);
    double start = clock_ms();
    if (status == STATUS_DONE)
        status = pack_scene(&bench->job.packed, &bench->job.scene, picture, &point->packed);
    if (status == STATUS_DONE && on_device)
        status = tracer_create(bench->context, &point->packed,
                               &(struct tracer_options){.double_precision = is_double,
                                                        .fast = point->plan.fast,
                                                        .shaders = point->plan.shaders},
                               &point->tracer);
    point->setup_ms = clock_ms() - start;
    if (status == STATUS_DONE)
        status = run_point(point, &bench->image, &point->first_ms);
    if (status == STATUS_DONE && on_device) {
        struct render_plan in_float = point->plan;
        in_float.precision = PRECISION_FLOAT;
        status = rays_on_device(bench->context, &in_float, &point->rays);
    }
    if (status != STATUS_DONE)
        stop_point(point);
    return status;
}

/* Whether the point takes too long, by the last one of its family: times are in proportion to samples. That
 * one is run warm if its first run, which compiles, does not tell. */
static enum status foresee(struct bench *bench, const struct bench_point *point, bool *too_long)
{
    struct bench_point *last = bench->count > 0 ? &bench->points[bench->count - 1] : NULL;
    *too_long = false;
    if (!last || last->family != point->family)
        return STATUS_DONE;
    const struct picture_settings *now = &point->picture, *then = &last->picture;
    double more = (double)now->samples / then->samples * now->light_samples / then->light_samples;
    double longest_ms = bench->effort->longest_run_ms / more, warm_ms = 0;
    if (more <= 1 || last->first_ms <= longest_ms)
        return STATUS_DONE;
    enum status status = run_point(last, &bench->image, &warm_ms);
    *too_long = warm_ms > longest_ms;
    return status;
}

/* Starts the points, and measures their errors by their first pictures. What takes too long is left out. */
static enum status start_points(struct bench *bench)
{
    const size_t count = bench->count;
    enum status status = STATUS_DONE;
    bench->count = 0;
    for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
        struct bench_point *point = &bench->points[bench->count];
        bool too_long;
        *point = bench->points[i];
        if (clock_ms() - bench->start_ms > bench->effort->whole_ms && point->family >= FAMILY_MAX_ERROR) {
            log_warning("%s: no time for %zu of %zu settings", bench->job.scene.path, count - i, count);
            break;
        }
        progress_advance(&bench->progress, START_SHARE / count);
        status = foresee(bench, point, &too_long);
        if (status != STATUS_DONE || too_long)
            continue;
        status = start_point(bench, point);
        if (status == STATUS_DONE) {
            ++bench->count;
            status = bench_error_measure(&bench->image,
                                         point->family == FAMILY_SAMPLES ? &bench->filtered : &bench->truth,
                                         &point->error);
        }
    }
    return status;
}

/* Runs all points warm in rounds, one run of each in a round, so that what disturbs the machine for a while
 * disturbs all of them; every other round runs backward, so that a steady drift cancels. */
static enum status run_rounds(struct bench *bench)
{
    const struct bench_effort *effort = bench->effort;
    const double start = clock_ms();
    const double runs_ms = fmin(effort->runs.all_ms, fmax(effort->whole_ms - (start - bench->start_ms), 1));
    enum status status = STATUS_DONE;
    uint64_t shown = 0;
    bool going_on = true;
    for (size_t round = 0; going_on && status == STATUS_DONE; ++round) {
        going_on = false;
        for (size_t i = 0; i < bench->count && status == STATUS_DONE; ++i) {
            struct bench_point *point = &bench->points[round % 2 ? bench->count - 1 - i : i];
            const double run_start = clock_ms();
            double elapsed = fmin((run_start - start) / runs_ms, 1); /* of the time */
            bool is_over = point->spent_ms >= effort->runs.point_ms || elapsed >= 1;
            if (point->run_count >= (is_over ? effort->runs.least : effort->runs.most))
                continue;
            going_on = true;
            status = run_point(point, &bench->image, &point->runs_ms[point->run_count]);
            point->spent_ms += clock_ms() - run_start;
            point->run_count += status == STATUS_DONE;
            uint64_t now = (uint64_t)((double)RUNS_SHARE * elapsed);
            progress_advance(&bench->progress, now - shown);
            shown = now;
        }
    }
    return status;
}

enum status bench_measure(struct bench *bench)
{
    bench_settings(bench);
    enum status status = start_points(bench);
    if (status == STATUS_DONE)
        status = run_rounds(bench);
    for (size_t i = 0; i < bench->count; ++i) {
        struct bench_point *point = &bench->points[i];
        sort_doubles(point->runs_ms, point->run_count);
        point->median_ms = sorted_quantile(point->runs_ms, point->run_count, 0.5);
        point->quartiles_ms[0] = sorted_quantile(point->runs_ms, point->run_count, 0.25);
        point->quartiles_ms[1] = sorted_quantile(point->runs_ms, point->run_count, 0.75);
        stop_point(point);
    }
    image_destroy(&bench->image);
    return status;
}
