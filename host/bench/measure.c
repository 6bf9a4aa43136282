#include "bench/measure.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/statistics.h"

static struct render_plan plan_of(const struct bench_point *point)
{
    return (struct render_plan){
        .scene = &point->packed,
        .window = {0, 0, (unsigned)point->packed.width, (unsigned)point->packed.height},
        .precision = point->setting.precision,
        .threads = point->setting.threads,
        .fast = point->setting.fast,
        .quiet = true,
    };
}

enum status bench_point_run(struct bench_point *point, struct image *image, double *milliseconds)
{
    struct render_plan plan = plan_of(point);
    if (point->tracer) {
        struct progress unseen;
        progress_start(&unseen, "", 1, true);
        return tracer_render(point->tracer, plan.window, image, &unseen, milliseconds);
    }
    struct rendering rendering;
    enum status status = render_on_cpu(&plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    *milliseconds = rendering.first_dispatch_ms;
    point->rays = rendering.rays;
    image_destroy(image);
    *image = rendering.image;
    return STATUS_DONE;
}

enum status bench_point_start(struct vulkan_context *context, const struct scene *scene,
                              struct bench_point *point, struct image *image)
{
    struct bench_setting *setting = &point->setting;
    bool is_double = setting->precision == PRECISION_DOUBLE, on_device = setting->backend == BACKEND_VULKAN;
    image_destroy(image);
    enum status status = image_create(setting->picture.width, setting->picture.height, image);
    if (status == STATUS_DONE && on_device && is_double)
        status = image_widen(image);
    double start = clock_ms();
    if (status == STATUS_DONE)
        status = pack_scene(scene, &setting->picture, &point->packed);
    if (status == STATUS_DONE && on_device)
        status = tracer_create(context, &point->packed,
                               &(struct tracer_options){.double_precision = is_double, .fast = setting->fast},
                               &point->tracer);
    point->setup_ms = clock_ms() - start;
    if (status == STATUS_DONE)
        status = bench_point_run(point, image, &point->first_ms);
    if (status != STATUS_DONE)
        bench_point_destroy(point);
    return status;
}

void bench_point_destroy(struct bench_point *point)
{
    tracer_destroy(&point->tracer);
    pack_destroy(&point->packed);
}

/* The order of a round: the CPU's points spread evenly among the device's. */
static void interleave(const struct bench_point *points, size_t count, size_t *order)
{
    size_t totals[2] = {0}, placed[2] = {0}, next[2] = {0}; /* device, CPU */
    for (size_t i = 0; i < count; ++i)
        ++totals[points[i].setting.backend == BACKEND_CPU];
    for (size_t i = 0; i < count; ++i) {
        bool cpu = placed[0] == totals[0] || (placed[1] < totals[1] && placed[1] * count <= i * totals[1]);
        while ((points[next[cpu]].setting.backend == BACKEND_CPU) != cpu)
            ++next[cpu];
        order[i] = next[cpu]++;
        ++placed[cpu];
    }
}

static enum status run_warm(struct bench_point *point, struct image *image)
{
    double start = clock_ms();
    enum status status = interrupt_requested()
                             ? STATUS_INTERRUPTED
                             : bench_point_run(point, image, &point->runs_ms[point->run_count]);
    point->spent_ms += clock_ms() - start;
    point->run_count += status == STATUS_DONE;
    return status;
}

static bool is_content(const struct bench_point *point, const struct run_limits *limits, double elapsed)
{
    if (point->run_count < limits->least_runs)
        return false;
    return point->run_count >= limits->most_runs || point->spent_ms >= limits->point_ms ||
           elapsed >= limits->all_ms;
}

static void summarise(struct bench_point *point)
{
    sort_doubles(point->runs_ms, point->run_count);
    point->median_ms = sorted_quantile(point->runs_ms, point->run_count, 0.5);
    point->quartiles_ms[0] = sorted_quantile(point->runs_ms, point->run_count, 0.25);
    point->quartiles_ms[1] = sorted_quantile(point->runs_ms, point->run_count, 0.75);
}

enum status bench_run_rounds(struct bench_point *points, size_t count, const struct run_limits *limits,
                             struct image *image, struct progress *progress, double share)
{
    size_t *order = calloc(count + 1, sizeof *order);
    if (!order) {
        log_error("no memory for %zu points", count);
        return STATUS_UNABLE;
    }
    interleave(points, count, order);
    enum status status = STATUS_DONE;
    double start = clock_ms();
    uint64_t shown = 0;
    bool going_on = true;
    for (size_t round = 0; going_on && status == STATUS_DONE; ++round) {
        going_on = false;
        for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
            struct bench_point *point = &points[order[round % 2 ? count - 1 - i : i]];
            double elapsed = clock_ms() - start;
            if (is_content(point, limits, elapsed))
                continue;
            going_on = true;
            status = run_warm(point, image);
            uint64_t now = (uint64_t)(elapsed < limits->all_ms ? share * elapsed / limits->all_ms : share);
            progress_advance(progress, now - shown);
            shown = now;
        }
    }
    for (size_t i = 0; i < count; ++i)
        summarise(&points[i]);
    free(order);
    return status;
}

/* Whether two settings differ in speed or rounding alone. */
static bool same_picture(const struct picture_settings *a, const struct picture_settings *b)
{
    return a->max_bounces == b->max_bounces && a->samples == b->samples &&
           a->light_samples == b->light_samples && a->has_max_error == b->has_max_error &&
           a->max_error == b->max_error;
}

enum status bench_count_rays(struct vulkan_context *context, struct bench_point *points, size_t count)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
        struct bench_point *point = &points[i];
        struct render_plan plan = plan_of(point);
        for (size_t k = 0; k < count && point->rays.primary == 0; ++k)
            if (points[k].setting.precision == PRECISION_FLOAT &&
                same_picture(&points[k].setting.picture, &point->setting.picture))
                point->rays = points[k].rays;
        plan.precision = PRECISION_FLOAT;
        if (point->rays.primary == 0)
            status = rays_on_device(context, &plan, &point->rays);
    }
    return status;
}
