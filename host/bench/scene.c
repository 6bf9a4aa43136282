#include <math.h>

#include "base/clock.h"
#include "bench/document.h"

static const struct bench_effort full_effort = {
    .truth = {.quad = 1e8, .with_double = 1e10},
    .longest_run_ms = 8e3,
    .runs = {.least = 5, .most = BENCH_MAX_RUNS, .point_ms = 8e3, .all_ms = 60e3},
    .whole_ms = INFINITY,
};

static const struct bench_effort quick_effort = {
    .truth = {.quad = 12e6, .with_double = 1.6e9},
    .longest_run_ms = 700,
    .runs = {.least = 3, .most = 21, .point_ms = 1500, .all_ms = 9e3},
    .whole_ms = 40e3,
};

/* Finds out what there is to turn in the scene. */
static enum status examine(struct bench *bench)
{
    const struct scene *scene = &bench->job.scene;
    bench->job.plan.quiet = true;
    bench->picture = (struct picture_settings){
        .width = bench->job.plan.window.width,
        .height = bench->job.plan.window.height,
        .max_bounces = scene->max_bounces,
        .samples = 1,
        .light_samples = scene->light_samples,
    };
    bench->deepest = scene->max_bounces;
    bench->has_quad_lights = bench->job.packed.quad_light_count > 0;
    for (size_t i = 0; i < scene->object_count; ++i)
        bench->has_secondary_rays |= scene->materials[scene->objects[i].material].type != MATERIAL_MATTE;
    return bench->has_secondary_rays ? ground_truth_bounces(&bench->job.packed, &bench->deepest)
                                     : STATUS_DONE;
}

static enum status find_truths(struct bench *bench)
{
    const struct bench_effort *effort = bench->effort;
    struct picture_settings deep = bench->picture;
    deep.max_bounces = bench->deepest;
    enum status status = ground_truth_create(
        &bench->job.scene, &bench->job.packed, deep, bench->has_quad_lights ? TRUTH_OF_LIGHTS : TRUTH_EXACT,
        bench->has_quad_lights ? effort->truth.with_double : effort->truth.quad, &bench->progress,
        TRUTH_SHARE, &bench->truth);
    if (status == STATUS_DONE)
        status = ground_truth_create(&bench->job.scene, &bench->job.packed, bench->picture, TRUTH_OF_SAMPLES,
                                     effort->truth.with_double, &bench->progress, FILTERED_SHARE,
                                     &bench->filtered);
    return status;
}

enum status bench_scene(const struct job_options *options, struct vulkan_context *context, bool quick,
                        const char *path, json_t **scene)
{
    static enum status (*const steps[])(struct bench *) = {examine, find_truths, bench_measure};
    struct bench bench = {
        .context = context,
        .quick = quick,
        .effort = quick ? &quick_effort : &full_effort,
        .start_ms = clock_ms(),
    };
    *scene = NULL;
    enum status status = job_create(options, path, &bench.job);
    if (status != STATUS_DONE)
        return status;
    progress_start(&bench.progress, "measuring", TRUTH_SHARE + FILTERED_SHARE + START_SHARE + RUNS_SHARE,
                   options->plan.quiet);
    for (size_t i = 0; i < sizeof steps / sizeof *steps && status == STATUS_DONE; ++i)
        status = steps[i](&bench);
    progress_end(&bench.progress);
    if (status == STATUS_DONE)
        status = bench_describe(&bench, scene);
    grid_pixels_destroy(&bench.truth.pixels);
    grid_pixels_destroy(&bench.filtered.pixels);
    job_destroy(&bench.job);
    return status;
}
