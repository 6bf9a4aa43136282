#include "tracer/job.h"

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

enum status job_create_from(const struct job_options *options, struct scene *scene, struct job *job)
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
    enum status status = choose_window(&settings, &job->plan.window);
    if (status == STATUS_DONE)
        status = pack_scene(scene, &settings, &job->packed);
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
    scene_warn(&scene);
    return job_create_from(options, &scene, job);
}

void job_destroy(struct job *job)
{
    pack_destroy(&job->packed);
    scene_destroy(&job->scene);
}

enum status job_write(const struct job *job, const struct image *image, const char *const *paths,
                      size_t path_count, enum transfer transfer, const char *device)
{
    const struct image_metadata metadata = {
        .transfer = transfer,
        .scene = job->scene.path,
        .device = device,
        .precision = precision_name(job->plan.precision),
        .max_bounces = (unsigned)job->packed.max_bounces,
    };
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < path_count; ++i)
        status = status_worse(status, image_write(image, paths[i], &metadata));
    return status;
}
