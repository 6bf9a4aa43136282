#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "bench/document.h"
#include "check/compare.h"
#include "scene/warnings.h"

static const struct bench_effort efforts[] = {
    [false] = {.quad = 1e8,
               .with_double = 1e10,
               .explained = 4e7,
               .longest_run_ms = 8e3,
               .least_runs = 5,
               .most_runs = BENCH_MAX_RUNS,
               .point_ms = 8e3,
               .runs_ms = 60e3,
               .whole_ms = INFINITY},
    [true] = {.quad = 12e6, /* --quick */
              .with_double = 1.6e9,
              .explained = 4e6,
              .longest_run_ms = 700,
              .least_runs = 3,
              .most_runs = 21,
              .point_ms = 1500,
              .runs_ms = 9e3,
              .whole_ms = 40e3},
};

/* Finds out what there is to turn in the scene. */
static enum status examine(struct bench *bench)
{
    const struct scene *scene = &bench->scene;
    const struct bench_options *options = bench->options;
    bench->picture = (struct picture_settings){
        .width = options->width ? options->width : scene->width,
        .height = options->height ? options->height : scene->height,
        .max_bounces = scene->max_bounces,
        .samples = 1,
        .light_samples = scene->light_samples,
    };
    for (size_t i = 0; i < scene->object_count; ++i)
        bench->has_secondary_rays |= scene->materials[scene->objects[i].material].type != MATERIAL_MATTE;
    for (size_t i = 0; i < scene->light_count; ++i)
        bench->has_quad_lights |= scene->lights[i].type == LIGHT_QUAD;
    bench->deepest = scene->max_bounces;
    enum status status = pack_scene(scene, &bench->picture, &bench->packed);
    if (status == STATUS_DONE && bench->has_secondary_rays)
        status = ground_truth_bounces(&bench->packed, &bench->deepest);
    return status;
}

static enum status find_truths(struct bench *bench)
{
    const struct bench_effort *effort = bench->effort;
    struct picture_settings deep = bench->picture;
    deep.max_bounces = bench->deepest;
    enum status status =
        ground_truth_create(&bench->scene, deep, bench->has_quad_lights ? TRUTH_OF_LIGHTS : TRUTH_EXACT,
                            bench->has_quad_lights ? effort->with_double : effort->quad, &bench->progress,
                            TRUTH_SHARE, &bench->truth);
    if (status == STATUS_DONE)
        status = ground_truth_create(&bench->scene, bench->picture, TRUTH_OF_SAMPLES, effort->with_double,
                                     &bench->progress, FILTERED_SHARE, &bench->filtered);
    return status;
}

/* The reference's float picture against the exact one, with the error analysis. */
static enum status judge_rounding(struct bench *bench)
{
    struct grid_pixels pixels;
    struct image image;
    enum status status = grid_render(&bench->packed, PRECISION_FLOAT, true, bench->effort->explained,
                                     &bench->progress, ROUNDING_SHARE, &pixels);
    if (status != STATUS_DONE)
        return status;
    bench->rounding_pixels = pixel_grid_count(&pixels.grid);
    status = image_create(pixels.grid.columns, pixels.grid.rows, &image);
    if (status == STATUS_DONE) {
        for (size_t i = 0; i < 3 * bench->rounding_pixels; ++i)
            image.rgb[i] = (float)pixels.rgb[i];
        status = judge_picture(&image, pixels.signatures, pixels.explanations, &bench->rounding);
        image_destroy(&image);
    }
    grid_pixels_destroy(&pixels);
    return status == STATUS_DIFFERS ? STATUS_DONE : status; /* the result says so */
}

/* Whether device and reference agree in the scene's picture; and the pictures for the report. */
static enum status compare_backends(struct bench *bench)
{
    const struct render_plan plan = {.scene = &bench->packed,
                                     .window = {0, 0, bench->picture.width, bench->picture.height},
                                     .quiet = true};
    struct rendering reference, device = {0};
    struct comparison comparison = {0};
    enum status status = render_on_cpu(&plan, &reference);
    if (status != STATUS_DONE)
        return status;
    if (bench->context)
        status = render_on_device(bench->context, &plan, &device);
    if (bench->context && status == STATUS_DONE)
        status = image_compare(&device.image, &reference.image, NULL, &comparison);
    bench->differing = comparison.bit_differing;
    status = status == STATUS_DIFFERS ? STATUS_DONE : status; /* the result says so */
    if (status == STATUS_DONE && bench->options->wants_pictures)
        status = bench->context ? report_pictures(&device.image, &reference.image, &bench->pictures)
                                : report_pictures(&reference.image, NULL, &bench->pictures);
    image_destroy(&device.image);
    image_destroy(&reference.image);
    return status;
}

enum status bench_scene(const struct bench_options *options, struct vulkan_context *context, const char *path,
                        json_t **scene)
{
    static enum status (*const steps[])(struct bench *) = {examine, find_truths, judge_rounding,
                                                           bench_measure, compare_backends};
    struct bench bench = {
        .options = options,
        .effort = &efforts[options->quick],
        .context = context,
        .path = path,
        .start_ms = clock_ms(),
    };
    *scene = NULL;
    enum status status = scene_read(path, &bench.scene);
    if (status != STATUS_DONE)
        return status;
    scene_warn(&bench.scene);
    progress_start(&bench.progress, path,
                   TRUTH_SHARE + FILTERED_SHARE + ROUNDING_SHARE + START_SHARE + RUNS_SHARE, options->quiet);
    for (size_t i = 0; i < sizeof steps / sizeof *steps && status == STATUS_DONE; ++i)
        status = steps[i](&bench);
    progress_end(&bench.progress);
    if (status == STATUS_DONE) {
        *scene = bench_scene_document(&bench);
        status = *scene ? STATUS_DONE : STATUS_UNABLE;
    }
    for (size_t i = 0; i < bench.count; ++i)
        bench_point_destroy(&bench.points[i]);
    free(bench.points);
    json_decref(bench.pictures);
    image_destroy(&bench.image);
    grid_pixels_destroy(&bench.truth.pixels);
    grid_pixels_destroy(&bench.filtered.pixels);
    pack_destroy(&bench.packed);
    scene_destroy(&bench.scene);
    return status;
}
