#include "bench/scene.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "bench/document.h"
#include "bench/report.h"
#include "check/compare.h"
#include "scene/warnings.h"

/* What a bench may cost. */
struct effort {
    struct truth_effort truth;
    double longest_run_ms; /* a family ends where its next run would take longer */
    struct run_limits limits;
    double whole_ms; /* a bench that has taken longer starts no more knobs and makes the least runs only */
};

static const struct effort quick_effort = {
    .truth = {.quad = 12e6, .with_double = 1.6e9, .explained = 4e6, .samples = 1 << 16},
    .longest_run_ms = 700,
    .limits = {.least_runs = 3, .most_runs = 21, .point_ms = 1500, .all_ms = 9e3},
    .whole_ms = 40e3,
};

static const struct effort full_effort = {
    .truth = {.quad = 1e8, .with_double = 1e10, .explained = 4e7, .samples = 1 << 16},
    .longest_run_ms = 8e3,
    .limits = {.least_runs = 5, .most_runs = BENCH_MAX_RUNS, .point_ms = 8e3, .all_ms = 60e3},
    .whole_ms = INFINITY,
};

/* Of the progress bar. */
enum { TRUTH_SHARE = 120, FILTERED_SHARE = 220, ROUNDING_SHARE = 120, START_SHARE = 240, RUNS_SHARE = 300 };

struct bench {
    const struct bench_options *options;
    struct vulkan_context *context;
    const struct effort *effort;
    double start_ms;
    struct scene scene;
    struct packed_scene packed; /* as the scene says */
    struct bench_choice choice;
    struct bench_result result;
    struct image image; /* the last picture */
    json_t *pictures;   /* NULL unless wanted */
    struct progress progress;
};

/* The reference's float picture against the exact one, with the error analysis. */
static enum status judge_rounding(struct bench *bench)
{
    const double work = bench->effort->truth.explained;
    struct grid_pixels of_float, exact = {0};
    struct image image = {0};
    enum status status = grid_render(&bench->packed, GRID_FLOAT, work, &bench->progress, 0, &of_float);
    if (status != STATUS_DONE)
        return status;
    status = image_create(of_float.grid.columns, of_float.grid.rows, &image);
    size_t count = bench->result.rounding_pixels = pixel_grid_count(&of_float.grid);
    for (size_t i = 0; status == STATUS_DONE && i < 3 * count; ++i)
        image.rgb[i] = (float)of_float.rgb[i];
    if (status == STATUS_DONE)
        status =
            grid_render(&bench->packed, GRID_EXPLAINED_QUAD, work, &bench->progress, ROUNDING_SHARE, &exact);
    if (status == STATUS_DONE)
        status = judge_picture(&image, of_float.signatures, exact.explanations, &bench->result.rounding);
    grid_pixels_destroy(&of_float);
    grid_pixels_destroy(&exact);
    image_destroy(&image);
    return status == STATUS_DIFFERS ? STATUS_DONE : status; /* the result says so */
}

/* Whether device and reference agree in the scene's picture; and the pictures for the report. */
static enum status compare_backends(struct bench *bench)
{
    const struct picture_settings *picture = &bench->result.picture;
    struct render_plan plan = {
        .scene = &bench->packed, .window = {0, 0, picture->width, picture->height}, .quiet = true};
    struct rendering reference, device = {0};
    struct comparison comparison = {0};
    enum status status = render_on_cpu(&plan, &reference);
    if (status != STATUS_DONE)
        return status;
    if (bench->context) {
        status = render_on_device(bench->context, &plan, &device);
        if (status == STATUS_DONE)
            status = image_compare(&device.image, &reference.image, NULL, &comparison);
        bench->result.has_agreement = status == STATUS_DONE || status == STATUS_DIFFERS;
        bench->result.differing = bench->result.has_agreement ? comparison.bit_differing : 0;
        status = bench->result.has_agreement ? STATUS_DONE : status;
    }
    if (status == STATUS_DONE && bench->options->wants_pictures)
        status = bench->context ? report_pictures(&device.image, &reference.image, &bench->pictures)
                                : report_pictures(&reference.image, NULL, &bench->pictures);
    image_destroy(&device.image);
    image_destroy(&reference.image);
    return status;
}

/* Whether the setting takes too long, by the last one of its family: times are in proportion to samples. That
 * one is run warm if its first run, which compiles, does not tell. */
static enum status foresee(struct bench *bench, const struct bench_setting *setting, bool *too_long)
{
    const struct bench_result *result = &bench->result;
    struct bench_point *last = result->count > 0 ? &result->points[result->count - 1] : NULL;
    *too_long = false;
    if (!last || last->setting.family != setting->family)
        return STATUS_DONE;
    const struct picture_settings *now = &setting->picture, *then = &last->setting.picture;
    double more = (double)now->samples / then->samples * now->light_samples / then->light_samples;
    double longest_ms = bench->effort->longest_run_ms / more, warm_ms = 0;
    if (more <= 1 || last->first_ms <= longest_ms)
        return STATUS_DONE;
    enum status status = bench_point_run(last, &bench->image, &warm_ms);
    *too_long = warm_ms > longest_ms;
    return status;
}

/* Readies a setting, and measures its error by its first picture. What the device cannot do is left out. */
static enum status start_point(struct bench *bench, const struct bench_setting *setting)
{
    struct bench_result *result = &bench->result;
    struct bench_point *point = &result->points[result->count];
    *point = (struct bench_point){.setting = *setting};
    enum status status = bench_point_start(bench->context, &bench->scene, point, &bench->image);
    if (status == STATUS_UNABLE) {
        log_warning("%s: left out: %s", result->path, setting->label);
        return STATUS_DONE;
    }
    if (status != STATUS_DONE)
        return status;
    ++result->count;
    return bench_error_measure(
        &bench->image, setting->family == FAMILY_SAMPLES ? &result->filtered : &result->truth, &point->error);
}

static enum status start_points(struct bench *bench, const struct bench_setting *settings, size_t count)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
        bool late = clock_ms() - bench->start_ms > bench->effort->whole_ms;
        if (late && settings[i].family >= FAMILY_MAX_ERROR) {
            log_warning("%s: no time for %zu of %zu settings", bench->result.path, count - i, count);
            break;
        }
        bool too_long;
        status = foresee(bench, &settings[i], &too_long);
        if (status == STATUS_DONE && !too_long)
            status = start_point(bench, &settings[i]);
        progress_advance(&bench->progress, START_SHARE / count);
    }
    return status;
}

static enum status measure(struct bench *bench)
{
    struct bench_result *result = &bench->result;
    struct bench_setting settings[BENCH_MAX_SETTINGS];
    result->points = calloc(BENCH_MAX_SETTINGS, sizeof *result->points);
    if (!result->points) {
        log_error("%s: no memory for the settings of a bench", result->path);
        return STATUS_UNABLE;
    }
    enum status status = start_points(bench, settings, bench_settings(&bench->choice, settings));
    if (status == STATUS_DONE && bench->context)
        status = bench_count_rays(bench->context, result->points, result->count);
    struct run_limits limits = bench->effort->limits;
    double left = bench->effort->whole_ms - (clock_ms() - bench->start_ms);
    limits.all_ms = fmin(limits.all_ms, fmax(left, 1));
    if (status == STATUS_DONE)
        status = bench_run_rounds(result->points, result->count, &limits, &bench->image, &bench->progress,
                                  RUNS_SHARE);
    return status;
}

/* What there is to turn in the scene, which has been read. */
static void choose(struct bench *bench)
{
    const struct scene *scene = &bench->scene;
    const struct bench_options *options = bench->options;
    struct bench_choice *choice = &bench->choice;
    choice->picture = bench->result.picture = (struct picture_settings){
        .width = options->width ? options->width : scene->width,
        .height = options->height ? options->height : scene->height,
        .max_bounces = scene->max_bounces,
        .samples = 1,
        .light_samples = scene->light_samples,
    };
    choice->backend = bench->context ? BACKEND_VULKAN : BACKEND_CPU;
    choice->has_float64 = bench->context && bench->context->has_float64;
    for (size_t i = 0; i < scene->object_count; ++i)
        choice->has_secondary_rays |= scene->materials[scene->objects[i].material].type != MATERIAL_MATTE;
    for (size_t i = 0; i < scene->light_count; ++i)
        choice->has_quad_lights |= scene->lights[i].type == LIGHT_QUAD;
    choice->deepest = scene->max_bounces;
    choice->quick = options->quick;
    bench->result.sampled = choice->has_quad_lights;
}

/* All steps, with the scene read. */
static enum status run(struct bench *bench)
{
    struct bench_result *result = &bench->result;
    const struct truth_effort *effort = &bench->effort->truth;
    choose(bench);
    struct picture_settings deep = result->picture;
    enum status status = pack_scene(&bench->scene, &result->picture, &bench->packed);
    if (status == STATUS_DONE && bench->choice.has_secondary_rays)
        status = ground_truth_bounces(&bench->packed, &bench->choice.deepest);
    deep.max_bounces = bench->choice.deepest;
    if (status == STATUS_DONE)
        status = ground_truth_create(&bench->scene, deep, result->sampled ? TRUTH_OF_LIGHTS : TRUTH_EXACT,
                                     effort, &bench->progress, TRUTH_SHARE, &result->truth);
    if (status == STATUS_DONE)
        status = ground_truth_create(&bench->scene, result->picture, TRUTH_OF_SAMPLES, effort,
                                     &bench->progress, FILTERED_SHARE, &result->filtered);
    if (status == STATUS_DONE)
        status = judge_rounding(bench);
    if (status == STATUS_DONE)
        status = measure(bench);
    if (status == STATUS_DONE)
        status = compare_backends(bench);
    return status;
}

static enum status describe(struct bench *bench, json_t **document)
{
    bench_mark_pareto(bench->result.points, bench->result.count);
    *document = bench_scene_document(&bench->result);
    if (*document && (!bench->pictures || json_object_set(*document, "pictures", bench->pictures) == 0))
        return STATUS_DONE;
    log_error("no memory for the result of %s, or its name is not UTF-8", bench->result.path);
    json_decref(*document);
    *document = NULL;
    return STATUS_UNABLE;
}

enum status bench_scene(const struct bench_options *options, struct vulkan_context *context, const char *path,
                        json_t **document)
{
    struct bench bench = {
        .options = options,
        .context = context,
        .effort = options->quick ? &quick_effort : &full_effort,
        .start_ms = clock_ms(),
        .result.path = path,
    };
    *document = NULL;
    enum status status = scene_read(path, &bench.scene);
    if (status != STATUS_DONE)
        return status;
    scene_warn(&bench.scene);
    progress_start(&bench.progress, path,
                   TRUTH_SHARE + FILTERED_SHARE + ROUNDING_SHARE + START_SHARE + RUNS_SHARE, options->quiet);
    status = run(&bench);
    progress_end(&bench.progress);
    if (status == STATUS_DONE)
        status = describe(&bench, document);
    for (size_t i = 0; i < bench.result.count; ++i)
        bench_point_destroy(&bench.result.points[i]);
    free(bench.result.points);
    json_decref(bench.pictures);
    image_destroy(&bench.image);
    grid_pixels_destroy(&bench.result.truth.pixels);
    grid_pixels_destroy(&bench.result.filtered.pixels);
    pack_destroy(&bench.packed);
    scene_destroy(&bench.scene);
    return status;
}
