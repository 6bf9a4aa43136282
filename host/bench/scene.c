#include "bench/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "bench/document.h"
#include "bench/pictures.h"
#include "scene/warnings.h"

/* What a bench may cost. */
struct effort {
    struct bench_effort truth;
    double explained_work;
    double longest_run_ms; /* a family ends where its next run would take longer */
    struct run_limits limits;
    double whole_ms; /* a bench that has taken longer starts no more knobs and makes the least runs only */
    double truth_share, filtered_share, explained_share, start_share; /* of the progress bar, in ms */
};

static const struct effort quick_effort = {
    .truth = {.quad_work = 12e6, .double_work = 1.6e9, .samples = 1 << 16},
    .explained_work = 4e6,
    .longest_run_ms = 700,
    .limits = {.least_runs = 3, .most_runs = 21, .point_ms = 1500, .all_ms = 9e3},
    .whole_ms = 40e3,
    .truth_share = 4e3,
    .filtered_share = 7e3,
    .explained_share = 4e3,
    .start_share = 8e3,
};

static const struct effort full_effort = {
    .truth = {.quad_work = 1e8, .double_work = 1e10, .samples = 1 << 16},
    .explained_work = 4e7,
    .longest_run_ms = 8e3,
    .limits = {.least_runs = 5, .most_runs = BENCH_MAX_RUNS, .point_ms = 8e3, .all_ms = 60e3},
    .whole_ms = INFINITY,
    .truth_share = 40e3,
    .filtered_share = 60e3,
    .explained_share = 40e3,
    .start_share = 60e3,
};

struct bench {
    struct vulkan_context *context;
    const char *path;
    const struct effort *effort;
    double start_ms;
    struct scene scene;
    struct picture_settings picture;
    struct ground_truth truth, filtered;
    struct bench_point *points;
    size_t count;
    struct bench_result result;
    json_t *pictures; /* NULL unless wanted */
    struct progress progress;
    bool wants_pictures;
};

/* The reference's float picture against the exact one, with the error analysis. */
static enum status judge_rounding(struct bench *bench)
{
    struct packed_scene packed;
    struct picture_settings picture = bench->picture;
    enum status status = pack_scene(&bench->scene, &picture, &packed);
    if (status != STATUS_DONE)
        return status;
    struct pixel_grid grid = pixel_grid_fitting(
        picture.width, picture.height, bench_explained_pixels(&packed, bench->effort->explained_work));
    size_t count = pixel_grid_count(&grid);
    struct image image;
    struct grid_pixels of_float = {.rgb = calloc(count, 3 * sizeof(double)),
                                   .signatures = calloc(count, sizeof(uint32_t))};
    struct grid_pixels exact = {.explanations = calloc(count, sizeof *exact.explanations)};
    status = of_float.rgb && of_float.signatures && exact.explanations
                 ? image_create(grid.columns, grid.rows, &image)
                 : STATUS_UNABLE;
    if (status == STATUS_DONE) {
        status = pixel_grid_render(&packed, PRECISION_FLOAT, &grid, &of_float, NULL, 0);
        if (status == STATUS_DONE)
            status = pixel_grid_render(&packed, PRECISION_QUAD, &grid, &exact, &bench->progress,
                                       bench->effort->explained_share);
        for (size_t i = 0; i < 3 * count; ++i)
            image.rgb[i] = (float)of_float.rgb[i];
        if (status == STATUS_DONE)
            status = judge_picture(&image, of_float.signatures, exact.explanations, &bench->result.rounding);
        if (status == STATUS_DIFFERS)
            status = STATUS_DONE; /* the result says so */
        bench->result.rounding_pixels = count;
        image_destroy(&image);
    }
    free(of_float.rgb);
    free(of_float.signatures);
    free(exact.explanations);
    pack_destroy(&packed);
    return status;
}

/* Says how long the step took that began at *since. */
static void log_step(const struct bench *bench, const char *step, double *since)
{
    double now = clock_ms();
    log_info("%s: %s: %.1f s", bench->path, step, (now - *since) / 1000);
    *since = now;
}

static enum status find_truth(struct bench *bench, unsigned deepest)
{
    const struct effort *effort = bench->effort;
    double since = clock_ms();
    enum status status = ground_truth_create(&bench->scene, bench->picture, deepest, &effort->truth,
                                             &bench->progress, effort->truth_share, &bench->truth);
    log_step(bench, "truth", &since);
    if (status == STATUS_DONE)
        status = ground_truth_create_filtered(&bench->scene, bench->picture, &effort->truth, &bench->progress,
                                              effort->filtered_share, &bench->filtered);
    log_step(bench, "truth for pixel samples", &since);
    if (status == STATUS_DONE)
        status = judge_rounding(bench);
    log_step(bench, "rounding", &since);
    return status;
}

static bool is_as_the_scene_says(const struct bench_setting *setting, enum backend backend)
{
    return setting->family == (backend == BACKEND_CPU ? FAMILY_CPU : FAMILY_MODE) && !setting->fast &&
           setting->precision == PRECISION_FLOAT && setting->threads == 0;
}

/* Keeps the device's exact picture to compare the reference's with. */
static enum status compare_backends(struct bench *bench, const struct bench_setting *setting,
                                    const struct image *image, struct image *device)
{
    if (is_as_the_scene_says(setting, BACKEND_VULKAN)) {
        enum status status = image_create(image->width, image->height, device);
        if (status == STATUS_DONE)
            memcpy(device->rgb, image->rgb, (size_t)image->width * image->height * 3 * sizeof *image->rgb);
        return status;
    }
    if (!is_as_the_scene_says(setting, BACKEND_CPU))
        return STATUS_DONE;
    enum status status = STATUS_DONE;
    if (device->rgb) {
        bench->result.has_agreement = true;
        status = image_compare(device, image, NULL, &bench->result.agreement);
    }
    if (bench->wants_pictures && (status == STATUS_DONE || status == STATUS_DIFFERS))
        return bench_pictures(device->rgb ? device : image, device->rgb ? image : NULL, &bench->pictures);
    return status == STATUS_DIFFERS ? STATUS_DONE : status;
}

/* A family's next setting takes longer in proportion to its samples. */
static enum status foresee(struct bench *bench, const struct bench_setting *setting, struct image *image,
                           bool *too_long)
{
    *too_long = false;
    struct bench_point *before = bench->count > 0 ? &bench->points[bench->count - 1] : NULL;
    if (!before || before->setting.family != setting->family || before->setting.fast != setting->fast)
        return STATUS_DONE;
    const struct picture_settings *now = &setting->picture, *then = &before->setting.picture;
    double more = (double)now->samples / then->samples * now->light_samples / then->light_samples;
    double longest = bench->effort->longest_run_ms, warm_ms = 0;
    if (more <= 1 || before->first_ms * more <= longest)
        return STATUS_DONE;
    enum status status = bench_point_run(before, image, &warm_ms);
    *too_long = warm_ms * more > longest;
    return status;
}

/* Readies every setting, and measures its error by its first picture. */
static enum status start_points(struct bench *bench, const struct bench_setting *settings, size_t count,
                                struct image *image)
{
    struct image device = {0};
    enum status status = STATUS_DONE;
    const struct bench_setting *skipped = NULL; /* with it the rest of its family */
    for (size_t i = 0; i < count && status == STATUS_DONE; ++i) {
        struct bench_point *point = &bench->points[bench->count];
        bool too_long;
        if (skipped && settings[i].family == skipped->family && settings[i].fast == skipped->fast)
            continue;
        if (settings[i].family >= FAMILY_MAX_ERROR &&
            clock_ms() - bench->start_ms > bench->effort->whole_ms) {
            log_warning("%s: no time for %zu of %zu settings", bench->path, count - i, count);
            break;
        }
        status = foresee(bench, &settings[i], image, &too_long);
        skipped = too_long ? &settings[i] : NULL;
        if (too_long || status != STATUS_DONE)
            continue;
        *point = (struct bench_point){.setting = settings[i]};
        status = bench_point_start(bench->context, &bench->scene, point, image);
        progress_advance(&bench->progress, (uint64_t)(bench->effort->start_share / (double)count));
        if (status == STATUS_UNABLE) {
            log_warning("%s: left out: %s", bench->path, settings[i].label);
            status = STATUS_DONE;
            continue;
        }
        if (status != STATUS_DONE)
            break;
        ++bench->count;
        status = bench_error_measure(
            image, settings[i].family == FAMILY_SAMPLES ? &bench->filtered : &bench->truth, &point->error);
        if (status == STATUS_DONE)
            status = compare_backends(bench, &settings[i], image, &device);
        free(image->rgb64);
        image->rgb64 = NULL;
    }
    image_destroy(&device);
    return status;
}

static enum status measure(struct bench *bench, unsigned deepest, bool has_secondary_rays)
{
    struct bench_choice choice = {
        .picture = bench->picture,
        .backend = bench->context ? BACKEND_VULKAN : BACKEND_CPU,
        .has_float64 = bench->context && bench->context->has_float64,
        .has_secondary_rays = has_secondary_rays,
        .deepest = deepest,
        .quick = bench->effort == &quick_effort,
    };
    for (size_t i = 0; i < bench->scene.light_count; ++i)
        choice.has_quad_lights = choice.has_quad_lights || bench->scene.lights[i].type == LIGHT_QUAD;
    struct bench_setting *settings = calloc(BENCH_MAX_SETTINGS, sizeof *settings);
    bench->points = calloc(BENCH_MAX_SETTINGS, sizeof *bench->points);
    struct image image = {0};
    double since = clock_ms();
    enum status status = settings && bench->points
                             ? image_create(bench->picture.width, bench->picture.height, &image)
                             : STATUS_UNABLE;
    if (status == STATUS_DONE)
        status = start_points(bench, settings, bench_settings(&choice, settings), &image);
    free(settings);
    log_step(bench, "first pictures", &since);
    if (status == STATUS_DONE && bench->context)
        status = bench_count_rays(bench->context, bench->points, bench->count);
    log_step(bench, "rays", &since);
    struct run_limits limits = bench->effort->limits;
    double left = bench->effort->whole_ms - (clock_ms() - bench->start_ms);
    limits.all_ms = fmin(limits.all_ms, fmax(left, 0));
    if (status == STATUS_DONE)
        status = bench_run_rounds(bench->points, bench->count, &limits, &image, &bench->progress);
    log_step(bench, "warm runs", &since);
    image_destroy(&image);
    return status;
}

static json_t *describe(struct bench *bench)
{
    bool discrete =
        bench->context && (bench->context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ||
                           bench->context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU);
    bench_mark_pareto(bench->points, bench->count);
    bench->result.path = bench->path;
    bench->result.picture = bench->picture;
    bench->result.points = bench->points;
    bench->result.count = bench->count;
    bench->result.truth = &bench->truth;
    bench->result.filtered = &bench->filtered;
    bench->result.meters_device = !discrete;
    json_t *document = bench_scene_document(&bench->result);
    if (document && bench->pictures)
        json_object_set(document, "pictures", bench->pictures);
    return document;
}

/* Warns, once, of what is doubtful in the scene. */
static enum status try_scene(const struct bench *bench)
{
    struct packed_scene packed;
    enum status status = pack_scene(&bench->scene, &bench->picture, &packed);
    if (status == STATUS_DONE)
        pack_destroy(&packed);
    return status;
}

enum status bench_scene(const struct bench_options *options, struct vulkan_context *context, const char *path,
                        json_t **document)
{
    const struct effort *effort = options->quick ? &quick_effort : &full_effort;
    struct bench bench = {
        .context = context,
        .path = path,
        .effort = effort,
        .start_ms = clock_ms(),
        .wants_pictures = options->wants_pictures,
    };
    unsigned deepest;
    bool has_secondary_rays;
    *document = NULL;
    enum status status = scene_read(path, &bench.scene);
    if (status != STATUS_DONE)
        return status;
    scene_warn(&bench.scene);
    bench.picture = (struct picture_settings){
        .width = options->width ? options->width : bench.scene.width,
        .height = options->height ? options->height : bench.scene.height,
        .max_bounces = bench.scene.max_bounces,
        .samples = 1,
        .light_samples = bench.scene.light_samples,
    };
    progress_start(&bench.progress, path,
                   (uint64_t)(effort->truth_share + effort->filtered_share + effort->explained_share +
                              effort->start_share + effort->limits.all_ms),
                   options->quiet);
    status = try_scene(&bench);
    if (status == STATUS_DONE)
        status = bench_deepest(&bench.scene, &bench.picture, &deepest, &has_secondary_rays);
    if (status == STATUS_DONE)
        status = find_truth(&bench, deepest);
    if (status == STATUS_DONE)
        status = measure(&bench, deepest, has_secondary_rays);
    progress_end(&bench.progress);
    if (status == STATUS_DONE) {
        *document = describe(&bench);
        if (!*document) {
            log_error("no memory for the result of %s, or its name is not UTF-8", path);
            status = STATUS_UNABLE;
        }
    }
    for (size_t i = 0; i < bench.count; ++i)
        bench_point_destroy(&bench.points[i]);
    free(bench.points);
    json_decref(bench.pictures);
    ground_truth_destroy(&bench.truth);
    ground_truth_destroy(&bench.filtered);
    scene_destroy(&bench.scene);
    return status;
}
