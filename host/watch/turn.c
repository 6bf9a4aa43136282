#include "watch/turn.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "scene/scene.h"
#include "scene/warnings.h"

/* Says that the picture on show is not what the files say. */
static void tell_failure(struct watching *watching, const char *what, const char *details,
                         double milliseconds)
{
    snprintf(watching->failure, sizeof watching->failure, "%s: %.*s", what, (int)strcspn(details, "\n"),
             details);
    char time[32] = "";
    if (milliseconds > 0)
        snprintf(time, sizeof time, " after %.1f ms", milliseconds);
    if (watching->shown)
        log_notice("%s%s; picture %u stays", what, time, watching->shown->number);
    else
        log_notice("%s%s; there is no picture yet", what, time);
}

static void tell_success(const struct picture *picture, double pipeline_ms, double saved_ms)
{
    char pipeline[64] = "same pipeline";
    if (pipeline_ms > 0)
        snprintf(pipeline, sizeof pipeline, "pipeline %s in %.1f ms",
                 picture->number > 1 ? "rebuilt" : "built", pipeline_ms);
    log_notice("picture %u: %s, rendered in %.1f ms, %.1f ms from save to picture", picture->number, pipeline,
               picture->dispatch_ms, clock_ms() - saved_ms);
}

/* The size and the part of the picture divided by the reduction. */
static struct job_options reduced_options(const struct job_options *options, const struct scene *scene,
                                          unsigned reduction)
{
    struct job_options reduced = *options;
    if (reduction == 1)
        return reduced;
    reduced.width = ((options->width ? options->width : scene->width) + reduction - 1) / reduction;
    reduced.height = ((options->height ? options->height : scene->height) + reduction - 1) / reduction;
    reduced.crop.x /= reduction;
    reduced.crop.y /= reduction;
    reduced.crop.width = (reduced.crop.width + reduction - 1) / reduction;
    reduced.crop.height = (reduced.crop.height + reduction - 1) / reduction;
    return reduced;
}

static void place_camera(struct watching *watching, struct scene *scene)
{
    if (!watching->has_camera || memcmp(&watching->file_camera, &scene->camera, sizeof scene->camera) != 0)
        watching->file_camera = watching->camera = scene->camera;
    watching->has_camera = true;
    scene->camera = watching->camera;
}

static enum status read_scene(struct watching *watching, unsigned reduction)
{
    const struct watch_inputs *inputs = &watching->inputs;
    struct scene scene;
    picture_release(&watching->wanted);
    if (!inputs->scene) {
        fprintf(stderr, "%s: error: %s\n", inputs->scene_path, strerror(inputs->scene_error));
        return STATUS_REFUSED;
    }
    enum status status = scene_read_text(inputs->scene_path, inputs->scene, inputs->scene_length, &scene);
    if (status != STATUS_DONE)
        return status;
    if (reduction == 1)
        scene_warn(&scene);
    place_camera(watching, &scene);
    const struct job_options options = reduced_options(&watching->options->job, &scene, reduction);
    watching->wanted = picture_create();
    status = watching->wanted ? job_create_from(&options, &scene, &watching->wanted->job) : STATUS_UNABLE;
    if (status != STATUS_DONE)
        picture_release(&watching->wanted);
    scene_destroy(&scene); /* empty, unless there was no memory for the picture */
    return status;
}

/* Renders what is wanted. */
static enum status render(struct watching *watching, double *pipeline_ms)
{
    struct picture *picture = watching->wanted;
    enum status status = live_shader_render(&watching->live, picture, pipeline_ms);
    if (status == STATUS_DONE && watching->options->window && !watching->window)
        status = watch_window_create(watching->live.context, picture->image.width, picture->image.height,
                                     &watching->window);
    if (status == STATUS_DONE && watching->window)
        status = watch_window_show(watching->window, &picture->image, watching->options->transfer);
    return status;
}

static enum status renew_picture(struct watching *watching, double saved_ms)
{
    struct picture *picture = watching->wanted;
    double pipeline_ms;
    enum status status = render(watching, &pipeline_ms);
    if (status == STATUS_DONE)
        status = job_write(&picture->job, &picture->image, watching->options->outputs,
                           watching->options->output_count, watching->options->transfer,
                           watching->live.context->properties.deviceName);
    if (status == STATUS_INTERRUPTED)
        return status;
    if (status != STATUS_DONE) {
        tell_failure(watching, "rendering failed", "see the terminal", 0);
        return status;
    }
    picture->number = watching->shown ? watching->shown->number + 1 : 1;
    picture_release(&watching->shown);
    watching->shown = picture_share(picture);
    watching->failure[0] = 0;
    tell_success(picture, pipeline_ms, saved_ms);
    if (watching->check)
        background_check_submit(watching->check, picture);
    return STATUS_DONE;
}

enum status watch_turn(struct watching *watching, double saved_ms)
{
    double compile_ms;
    enum status status = read_scene(watching, 1);
    if (status != STATUS_DONE) {
        tell_failure(watching, "scene refused", "see the terminal", 0);
        return status;
    }
    status = live_shader_compile(&watching->live, watching->wanted, &watching->inputs.shader,
                                 watching->shader_changed, &compile_ms);
    watching->shader_changed = false;
    if (status == STATUS_REFUSED)
        tell_failure(watching, "compile failed", watching->live.compilation.messages, compile_ms);
    else if (status == STATUS_UNABLE)
        tell_failure(watching, "compile failed", "see the terminal", compile_ms);
    return status == STATUS_DONE ? renew_picture(watching, saved_ms) : status;
}

enum status watch_preview(struct watching *watching, unsigned reduction)
{
    double pipeline_ms, start = clock_ms();
    if (watching->failure[0])
        return STATUS_DONE;
    enum status status = read_scene(watching, reduction);
    if (status == STATUS_DONE)
        status = render(watching, &pipeline_ms);
    if (status == STATUS_DONE)
        log_info("moving: every %u pixels in %.1f ms", reduction, clock_ms() - start);
    return status;
}
