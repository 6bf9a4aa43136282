#include "watch/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "scene/warnings.h"

/* Says that the picture on show is not what the files say. */
static void tell_failure(struct session *session, const char *what, const char *details, double milliseconds)
{
    snprintf(session->failure, sizeof session->failure, "%s: %.*s", what, (int)strcspn(details, "\n"),
             details);
    char time[32] = "";
    if (milliseconds > 0)
        snprintf(time, sizeof time, " after %.1f ms", milliseconds);
    if (session->shown)
        log_notice("%s%s; picture %u stays", what, time, session->shown->number);
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
    reduced.width = ((options->width ? options->width : scene->width) + reduction - 1) / reduction;
    reduced.height = ((options->height ? options->height : scene->height) + reduction - 1) / reduction;
    reduced.plan.window.x /= reduction;
    reduced.plan.window.y /= reduction;
    reduced.plan.window.width = (reduced.plan.window.width + reduction - 1) / reduction;
    reduced.plan.window.height = (reduced.plan.window.height + reduction - 1) / reduction;
    return reduced;
}

/* Destroys a picture that nothing needs any more. */
static void release(const struct session *session, struct picture *picture)
{
    if (picture && picture != session->shown && picture != session->traced)
        picture_destroy(picture);
}

/* Puts the picture, or NULL, in the place of another one. */
static void replace(const struct session *session, struct picture **place, struct picture *picture)
{
    struct picture *old = *place;
    *place = picture;
    release(session, old);
}

/* The picture to be rendered of the scene, to be released by the caller; NULL (reported) where the scene is
 * refused. */
static struct picture *prepare(struct session *session, unsigned reduction)
{
    struct scene scene;
    if (!session->scene_text || scene_read_text(session->inputs.scene_path, session->scene_text,
                                                session->scene_length, &scene) != STATUS_DONE)
        return NULL;
    if (memcmp(&session->file_camera, &scene.camera, sizeof scene.camera) != 0)
        session->file_camera = session->camera = scene.camera;
    scene.camera = session->camera;
    const struct packed_scene *traced = session->traced ? &session->traced->job.packed : NULL;
    const struct job_options options = reduced_options(&session->options->job, &scene, reduction);
    struct picture *picture = calloc(1, sizeof *picture);
    if (!picture) {
        log_error("no memory for a picture");
        scene_destroy(&scene);
    } else if (job_create_from(&options, traced, &scene, &picture->job) != STATUS_DONE) {
        picture_destroy(picture);
        picture = NULL;
    } else if (session->scene_changed) {
        scene_warn(&picture->job.scene, &picture->job.packed);
        session->scene_changed = false;
    }
    return picture;
}

static struct tracer_options tracer_options(const struct session *session)
{
    const struct job_options *job = &session->options->job;
    return (struct tracer_options){.double_precision = job->plan.precision == PRECISION_DOUBLE,
                                   .fast = job->plan.fast,
                                   .code = {session->code, session->code_size}};
}

/* Compiles the shader as the choice wants it. STATUS_DIFFERS where its files have changed meanwhile: what
 * came of it does not count. */
static enum status compile_anew(struct session *session)
{
    struct inputs *inputs = &session->inputs;
    struct compilation compilation;
    enum status status = shader_build(inputs->shader_path, session->choice, &compilation);
    if (status == STATUS_DONE || status == STATUS_REFUSED) {
        const bool broken = status == STATUS_REFUSED, held = inputs_hold(inputs);
        if (held)
            inputs->shader_broken = broken;
        if (!held || !inputs_follow(inputs, INPUT_SHADER, &compilation.files))
            status = STATUS_DIFFERS;
    }
    free(session->messages);
    session->messages = compilation.messages;
    compilation.messages = NULL;
    if (status == STATUS_DONE && (!session->code || session->code_size != compilation.size ||
                                  memcmp(session->code, compilation.words, compilation.size) != 0)) {
        tracer_destroy(&session->tracer);
        free(session->code);
        session->code = compilation.words;
        session->code_size = compilation.size;
        compilation.words = NULL;
    }
    compilation_destroy(&compilation);
    return status;
}

/* Compiles the shader for the picture, unless that has been done already and it has not changed. *compile_ms
 * is 0 then. Prints the messages; STATUS_REFUSED where there are errors. */
static enum status compile(struct session *session, const struct picture *picture, double *compile_ms)
{
    const struct tracer_options options = tracer_options(session);
    const struct shader_choice choice = tracer_shader(session->context, &picture->job.packed, &options);
    bool compiled = session->compiled_state == session->inputs.taken.of[INPUT_SHADER] &&
                    choice.variant == session->choice.variant &&
                    choice.scene_in_storage == session->choice.scene_in_storage;
    double start = clock_ms();
    if (!compiled) {
        session->choice = choice;
        session->compiled = compile_anew(session);
        bool known = session->compiled == STATUS_DONE || session->compiled == STATUS_REFUSED;
        session->compiled_state = known ? session->inputs.taken.of[INPUT_SHADER] : 0;
    }
    *compile_ms = compiled ? 0 : clock_ms() - start;
    if (session->compiled == STATUS_REFUSED || (session->compiled == STATUS_DONE && !compiled))
        fputs(session->messages, stderr);
    return session->compiled;
}

/* Gives the picture its image. *pipeline_ms is the time that a new pipeline took to build, and 0 where the
 * one there was fits. After a failure the next picture gets a new one, whatever state this one is in. */
static enum status render(struct session *session, struct picture *picture, double *pipeline_ms)
{
    struct rendering rendering = {0};
    double start = clock_ms();
    enum status status = STATUS_DONE;
    *pipeline_ms = 0;
    if (!session->tracer || !tracer_update(session->tracer, &picture->job.packed)) {
        const struct tracer_options options = tracer_options(session);
        tracer_destroy(&session->tracer);
        status = tracer_create(session->context, &picture->job.packed, &options, &session->tracer);
        *pipeline_ms = clock_ms() - start;
    }
    if (status != STATUS_DONE)
        return status;
    replace(session, &session->traced, picture);
    status = render_repeatedly(render_once_on_device, session->tracer, &picture->job.plan, &rendering);
    picture->image = rendering.image;
    picture->dispatch_ms = rendering.times.dispatch_ms;
    if (status != STATUS_DONE)
        tracer_destroy(&session->tracer);
    else if (session->options->window)
        status = session_show(session, &picture->image);
    return status;
}

/* Opens the device again after it was lost. On failure (reported) there is no context. */
static void reopen_device(struct session *session)
{
    tracer_destroy(&session->tracer);
    vulkan_context_destroy(&session->context);
    if (vulkan_context_create(&session->options->vulkan, &session->context) == STATUS_DONE)
        log_notice("the device was lost, and opened again");
}

enum status session_show(struct session *session, const struct image *image)
{
    enum status status = STATUS_DONE;
    if (!session->display)
        status = display_create(image->width, image->height, &session->display);
    uint8_t *rgb =
        status == STATUS_DONE ? display_picture(session->display, image->width, image->height) : NULL;
    const size_t count = 3 * (size_t)image->width * image->height;
    if (!rgb)
        return STATUS_UNABLE;
    transfer_encode(&session->encoder, image->rgb, count, rgb);
    session->shows_difference = false;
    return display_paint(session->display);
}

void session_render(struct session *session, double saved_ms)
{
    const struct watch_options *options = session->options;
    const char *what = "scene refused", *details = "see the terminal";
    double compile_ms = 0, pipeline_ms = 0;
    struct picture *picture = prepare(session, 1);
    enum status status = STATUS_REFUSED;
    if (picture) {
        what = "compile failed";
        status = compile(session, picture, &compile_ms);
        if (status == STATUS_REFUSED)
            details = session->messages;
    }
    if (status == STATUS_DONE) {
        what = "rendering failed";
        compile_ms = 0;
        status = render(session, picture, &pipeline_ms);
    }
    if (status == STATUS_DONE)
        status = job_write(&picture->job, &picture->image, options->outputs, options->output_count,
                           options->transfer, session->context->properties.deviceName);
    if (status == STATUS_DONE) {
        picture->number = session->shown ? session->shown->number + 1 : 1;
        replace(session, &session->shown, picture);
        session->failure[0] = 0;
        tell_success(picture, pipeline_ms, saved_ms);
        picture->band = options->check ? 1 : 0;
        picture->since_ms = clock_ms();
    } else if (status != STATUS_DIFFERS) {
        tell_failure(session, what, details, compile_ms);
    }
    release(session, picture);
    if (session->context->lost)
        reopen_device(session);
}

void session_take(struct session *session, double saved_ms)
{
    size_t length;
    char *text = inputs_read_scene(&session->inputs, &length);
    char *sphere_files = text ? scene_list_files(session->inputs.scene_path, text, length) : NULL;
    if (!inputs_hold(&session->inputs) || !inputs_follow(&session->inputs, INPUT_SPHERES, &sphere_files)) {
        free(text);
        free(sphere_files);
        return;
    }
    session->scene_changed = !text || !session->scene_text || strcmp(text, session->scene_text) != 0 ||
                             session->spheres_state != session->inputs.taken.of[INPUT_SPHERES];
    session->spheres_state = session->inputs.taken.of[INPUT_SPHERES];
    free(session->scene_text);
    session->scene_text = text;
    session->scene_length = length;
    session_render(session, saved_ms);
}

void session_preview(struct session *session, unsigned reduction)
{
    double pipeline_ms;
    struct picture *picture = session->failure[0] ? NULL : prepare(session, reduction);
    if (picture)
        render(session, picture, &pipeline_ms);
    release(session, picture);
    if (session->context->lost)
        reopen_device(session);
}

enum status session_destroy(struct session *session)
{
    display_destroy(&session->display);
    tracer_destroy(&session->tracer);
    replace(session, &session->traced, NULL);
    replace(session, &session->shown, NULL);
    inputs_destroy(&session->inputs);
    free(session->code);
    free(session->messages);
    free(session->scene_text);
    return vulkan_context_destroy(&session->context);
}
