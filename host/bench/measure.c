#include "bench/measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/statistics.h"
#include "bench/energy.h"

static struct window whole(const struct packed_scene *packed)
{
    return (struct window){0, 0, (unsigned)packed->width, (unsigned)packed->height};
}

static struct render_plan plan_of(const struct bench_point *point)
{
    return (struct render_plan){
        .scene = &point->packed,
        .window = whole(&point->packed),
        .precision = point->setting.precision,
        .threads = point->setting.threads,
        .fast = point->setting.fast,
        .quiet = true,
    };
}

enum status bench_point_run(struct bench_point *point, struct image *image, double *milliseconds)
{
    struct progress unseen;
    struct rendering rendering;
    struct render_plan plan = plan_of(point);
    if (point->tracer) {
        progress_start(&unseen, "", 1, true);
        return tracer_render(point->tracer, plan.window, image, &unseen, milliseconds);
    }
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
    struct picture_settings picture = point->setting.picture;
    double start = clock_ms();
    enum status status = pack_scene(scene, &picture, &point->packed);
    if (status == STATUS_DONE && point->setting.backend == BACKEND_VULKAN) {
        status = tracer_create(context, &point->packed,
                               &(struct tracer_options){
                                   .double_precision = point->setting.precision == PRECISION_DOUBLE,
                                   .fast = point->setting.fast,
                               },
                               &point->tracer);
        if (status == STATUS_DONE && point->setting.precision == PRECISION_DOUBLE && !image->rgb64)
            status = image_widen(image);
    }
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
    size_t cpu = 0, device = 0, cpu_total = 0;
    for (size_t i = 0; i < count; ++i)
        cpu_total += points[i].setting.backend == BACKEND_CPU;
    size_t next_cpu = 0, next_device = 0;
    for (size_t i = 0; i < count; ++i) {
        bool takes_cpu = device == count - cpu_total || (cpu < cpu_total && cpu * count <= i * cpu_total);
        size_t *next = takes_cpu ? &next_cpu : &next_device;
        while ((points[*next].setting.backend == BACKEND_CPU) != takes_cpu)
            ++*next;
        order[i] = (*next)++;
        cpu += takes_cpu;
        device += !takes_cpu;
    }
}

static enum status run_warm(struct bench_point *point, struct image *image, struct energy_meter *meter)
{
    double before = 0, after = 0, milliseconds;
    bool metered = energy_meter_read(meter, &before);
    double start = clock_ms();
    enum status status = bench_point_run(point, image, &milliseconds);
    if (status != STATUS_DONE)
        return status;
    point->spent_ms += clock_ms() - start;
    metered = energy_meter_read(meter, &after) && metered;
    point->joules = metered ? point->joules + after - before : -1;
    point->runs_ms[point->run_count++] = milliseconds;
    return STATUS_DONE;
}

static bool is_content(const struct bench_point *point, const struct run_limits *limits, double elapsed)
{
    if (point->run_count < limits->least_runs)
        return false;
    return point->run_count >= limits->most_runs || point->spent_ms >= limits->point_ms ||
           elapsed >= limits->all_ms;
}

enum status bench_run_rounds(struct bench_point *points, size_t count, const struct run_limits *limits,
                             struct image *image, struct progress *progress)
{
    size_t *order = calloc(count + 1, sizeof *order);
    if (!order) {
        log_error("no memory for %zu points", count);
        return STATUS_UNABLE;
    }
    struct energy_meter meter;
    energy_meter_open(&meter, "/sys/class/powercap");
    interleave(points, count, order);
    enum status status = STATUS_DONE;
    double start = clock_ms(), shown = start;
    bool going_on = true;
    for (size_t round = 0; going_on && status == STATUS_DONE; ++round) {
        going_on = false;
        for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
            struct bench_point *point = &points[order[round % 2 ? count - 1 - i : i]];
            if (is_content(point, limits, clock_ms() - start))
                continue;
            going_on = true;
            status = interrupt_requested() ? STATUS_INTERRUPTED : run_warm(point, image, &meter);
            double now = clock_ms();
            progress_advance(progress, (uint64_t)(now - shown));
            shown += (double)(uint64_t)(now - shown);
        }
    }
    free(order);
    return status;
}

struct bench_times bench_point_times(const struct bench_point *point)
{
    double sorted[BENCH_MAX_RUNS];
    memcpy(sorted, point->runs_ms, point->run_count * sizeof *sorted);
    sort_doubles(sorted, point->run_count);
    return (struct bench_times){
        .median = sorted_quantile(sorted, point->run_count, 0.5),
        .quartiles = {sorted_quantile(sorted, point->run_count, 0.25),
                      sorted_quantile(sorted, point->run_count, 0.75)},
    };
}

static bool same_picture(const struct picture_settings *a, const struct picture_settings *b)
{
    return a->max_bounces == b->max_bounces && a->samples == b->samples &&
           a->light_samples == b->light_samples && a->has_max_error == b->has_max_error &&
           (!a->has_max_error || a->max_error == b->max_error);
}

/* Copies what a point with the same picture has, if there is one. */
static bool share_rays(const struct bench_point *points, size_t count, struct bench_point *point)
{
    for (size_t i = 0; i < count; ++i)
        if (points[i].rays.primary > 0 && points[i].setting.precision == PRECISION_FLOAT &&
            same_picture(&points[i].setting.picture, &point->setting.picture)) {
            point->rays = points[i].rays;
            return true;
        }
    return false;
}

/* How long the reference takes for the point's picture, by what it took for the scene's. */
static double reference_ms(const struct bench_point *points, size_t count, const struct bench_point *point)
{
    const struct picture_settings *picture = &point->setting.picture;
    for (size_t i = 0; i < count; ++i) {
        const struct picture_settings *known = &points[i].setting.picture;
        if (points[i].setting.family == FAMILY_CPU && points[i].setting.precision == PRECISION_FLOAT)
            return points[i].first_ms * picture->samples / known->samples * picture->light_samples /
                   known->light_samples;
    }
    return INFINITY;
}

enum status bench_count_rays(struct vulkan_context *context, struct bench_point *points, size_t count)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
        struct bench_point *point = &points[i];
        if (point->rays.primary > 0 || share_rays(points, count, point))
            continue;
        struct render_plan plan = plan_of(point);
        plan.precision = PRECISION_FLOAT;
        if (reference_ms(points, count, point) > point->setup_ms + point->first_ms) {
            status = rays_on_device(context, &plan, &point->rays);
            continue;
        }
        struct rendering rendering;
        status = render_on_cpu(&plan, &rendering);
        if (status != STATUS_DONE)
            break;
        point->rays = rendering.rays;
        image_destroy(&rendering.image);
    }
    return status;
}
