#include "tracer/job.h"

#include <inttypes.h>
#include <stdio.h>

#include "scene/digest.h"
#include "scene/warnings.h"

static enum status choose_window(const struct picture_settings *settings, struct window *window)
{
    if (window->width == 0)
        *window = (struct window){0, 0, settings->width, settings->height};
    if (window->x + window->width <= settings->width && window->y + window->height <= settings->height)
        return STATUS_DONE;
    log_error("--crop %u,%u,%u,%u: expected a part of the picture of %ux%u", window->x, window->y,
              window->width, window->height, settings->width, settings->height);
    return STATUS_REFUSED;
}

static enum status choose_tile(const struct job_options *options, struct job *job)
{
    job->tile = (struct tile){options->tile.number, options->tile.count, job->plan.window};
    if (job->tile.count == 0 || tile_rows(&job->tile, &job->plan.window, &job->plan.strips))
        return STATUS_DONE;
    log_error("--tile %u/%u: there are no more than %u rows of pixels", job->tile.number, job->tile.count,
              job->tile.whole.height);
    return STATUS_REFUSED;
}

enum status job_create_from(const struct job_options *options, const struct packed_scene *other,
                            struct scene *scene, struct job *job)
{
    *job = (struct job){.scene = *scene};
    *scene = (struct scene){0};
    scene = &job->scene;
    const struct picture_settings settings = {
        .width = options->width ? options->width : scene->width,
        .height = options->height ? options->height : scene->height,
        .max_bounces = options->max_bounces >= 0 ? (unsigned)options->max_bounces : scene->max_bounces,
        .samples = options->samples,
        .light_samples = options->light_samples ? options->light_samples : scene->light_samples,
        .has_max_error = options->has_max_error,
        .max_error = options->max_error,
    };
    job->plan = options->plan;
    job->plan.scene = &job->packed;
    job->max_error = options->has_max_error ? options->max_error : -1;
    enum status status = choose_window(&settings, &job->plan.window);
    if (status == STATUS_DONE)
        status = choose_tile(options, job);
    if (status == STATUS_DONE)
        status = pack_scene(other, scene, &settings, &job->packed);
    if (status != STATUS_DONE)
        job_destroy(job);
    return status;
}

enum status job_create(const struct job_options *options, const char *scene_path, struct job *job)
{
    *job = (struct job){0};
    struct scene scene;
    enum status status = scene_read(scene_path, &scene);
    if (status != STATUS_DONE)
        return status;
    status = job_create_from(options, NULL, &scene, job);
    if (status == STATUS_DONE)
        scene_warn(&job->scene, &job->packed);
    return status;
}

void job_destroy(struct job *job)
{
    pack_destroy(&job->packed);
    scene_destroy(&job->scene);
}

/* The settings that the picture depends on, as options of the command line. */
static void print_settings(const struct job *job, char settings[static 320])
{
    const struct packed_scene *packed = &job->packed;
    const struct window *whole = &job->tile.whole;
    char crop[64] = "", max_error[64] = "";
    if (whole->width != (unsigned)packed->width || whole->height != (unsigned)packed->height)
        snprintf(crop, sizeof crop, " --crop %u,%u,%u,%u", whole->x, whole->y, whole->width, whole->height);
    if (job->max_error >= 0)
        snprintf(max_error, sizeof max_error, " --max-error %.17g", job->max_error);
    snprintf(settings, 320,
             "--size %dx%d%s --max-bounces %d --samples %d --light-samples %d%s --precision %s%s",
             packed->width, packed->height, crop, packed->max_bounces, packed->samples, packed->light_samples,
             max_error, precision_name(job->plan.precision), job->plan.fast ? " --fast" : "");
}

enum status job_write(const struct job *job, const struct image *image, const char *const *paths,
                      size_t path_count, enum transfer transfer, const char *device)
{
    char settings[320], digest[17], tile[TILE_TEXT];
    print_settings(job, settings);
    bool takes_digest = false;
    for (size_t i = 0; i < path_count; ++i)
        takes_digest = takes_digest || image_format_of(paths[i]) == IMAGE_FORMAT_EXR;
    snprintf(digest, sizeof digest, "%016" PRIx64, takes_digest ? pack_digest(&job->packed) : 0);
    tile_print(&job->tile, tile);
    const struct image_metadata metadata = {
        .transfer = transfer,
        .scene = job->scene.path,
        .device = device,
        .precision = precision_name(job->plan.precision),
        .max_bounces = (unsigned)job->packed.max_bounces,
        .settings = settings,
        .digest = digest,
        .tile = job->tile.count > 0 ? tile : NULL,
        .picture_width = (unsigned)job->packed.width,
        .picture_height = (unsigned)job->packed.height,
        .window = job->plan.window,
        .strips = job->plan.strips,
    };
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < path_count; ++i)
        status = status_worse(status, image_write(image, paths[i], &metadata));
    return status;
}
