#include "watch/session.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "scene/scene.h"
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

static void place_camera(struct session *session, struct scene *scene)
{
    if (!session->has_camera || memcmp(&session->file_camera, &scene->camera, sizeof scene->camera) != 0)
        session->file_camera = session->camera = scene->camera;
    session->has_camera = true;
    scene->camera = session->camera;
}

/* The picture to be rendered of the scene, which is refused (reported) where it is NULL. */
static struct picture *prepare(struct session *session, unsigned reduction)
{
    struct scene scene;
    if (!session->scene_text || scene_read_text(session->inputs.scene_path, session->scene_text,
                                                session->scene_length, &scene) != STATUS_DONE)
        return NULL;
    if (session->scene_changed)
        scene_warn(&scene);
    session->scene_changed = false;
    place_camera(session, &scene);
    const struct job_options options = reduced_options(&session->options->job, &scene, reduction);
    struct picture *picture = picture_create();
    if (picture && job_create_from(&options, &scene, &picture->job) != STATUS_DONE)
        picture_release(&picture);
    scene_destroy(&scene); /* empty, unless there was no memory for the picture */
    return picture;
}

static struct tracer_options tracer_options(const struct session *session)
{
    const struct job_options *job = &session->options->job;
    return (struct tracer_options){.double_precision = job->precision == PRECISION_DOUBLE,
                                   .fast = job->fast,
                                   .code = {session->code, session->code_size}};
}

static void drop_tracer(struct session *session)
{
    tracer_destroy(&session->tracer);
    picture_release(&session->traced);
}

/* Whether the tracer can run the shader; puts the reason into the messages if not. */
static enum status check_interface(const struct session *session, struct compilation *compilation)
{
    char problem[128];
    if (tracer_provides((struct spirv){compilation->words, compilation->size}, session->choice, problem))
        return STATUS_DONE;
    free(compilation->messages);
    if (asprintf(&compilation->messages, "%s: error: %s\n", session->inputs.shader_path, problem) >= 0)
        return STATUS_REFUSED;
    compilation->messages = NULL;
    log_error("no memory for a message");
    return STATUS_UNABLE;
}

/* Compiles the shader as the choice wants it. STATUS_DIFFERS where its files have changed meanwhile: what
 * came of it does not count. */
static enum status compile_anew(struct session *session)
{
    struct compilation compilation;
    const struct shader_choice choice = session->choice;
    enum status status = shader_compile(
        session->inputs.shader_path, whitted_defines(choice.variant, choice.scene_in_storage), &compilation);
    if (status == STATUS_DONE)
        status = check_interface(session, &compilation);
    if ((status == STATUS_DONE || status == STATUS_REFUSED) &&
        !inputs_follow(&session->inputs, &compilation.files, status == STATUS_REFUSED))
        status = STATUS_DIFFERS;
    if (status == STATUS_DONE && (!session->code || session->code_size != compilation.size ||
                                  memcmp(session->code, compilation.words, compilation.size) != 0)) {
        drop_tracer(session);
        free(session->code);
        session->code = compilation.words;
        session->code_size = compilation.size;
        compilation.words = NULL;
    }
    free(session->messages);
    session->messages = compilation.messages;
    compilation.messages = NULL;
    compilation_destroy(&compilation);
    return status;
}

/* Compiles the shader for the picture, unless that has been done already and it has not changed. *compile_ms
 * is 0 then. Prints the messages; STATUS_REFUSED where there are errors. */
static enum status compile(struct session *session, const struct picture *picture, double *compile_ms)
{
    const struct tracer_options options = tracer_options(session);
    const struct shader_choice choice = tracer_shader(session->context, &picture->job.packed, &options);
    *compile_ms = 0;
    if (session->compiled_state != session->inputs.taken.shader ||
        choice.variant != session->choice.variant ||
        choice.scene_in_storage != session->choice.scene_in_storage) {
        double start = clock_ms();
        session->choice = choice;
        session->compiled = compile_anew(session);
        bool known = session->compiled == STATUS_DONE || session->compiled == STATUS_REFUSED;
        session->compiled_state = known ? session->inputs.taken.shader : 0;
        *compile_ms = clock_ms() - start;
    }
    bool wanted =
        session->compiled == STATUS_REFUSED || (session->compiled == STATUS_DONE && *compile_ms > 0);
    if (wanted)
        fputs(session->messages, stderr);
    return session->compiled;
}

static enum status build_tracer(struct session *session, struct picture *picture)
{
    const struct tracer_options options = tracer_options(session);
    drop_tracer(session);
    enum status status = tracer_create(session->context, &picture->job.packed, &options, &session->tracer);
    malloc_trim(0); /* a driver's compiler needs much memory for a moment */
    return status;
}

/* Gives the picture its image. *pipeline_ms is the time that a new pipeline took to build, and 0 where the
 * one there was fits. After a failure the next picture gets a new one, whatever state this one is in. */
static enum status render(struct session *session, struct picture *picture, double *pipeline_ms)
{
    const struct render_plan *plan = &picture->job.plan;
    struct progress progress;
    double start = clock_ms();
    enum status status = STATUS_DONE;
    *pipeline_ms = 0;
    if (!session->tracer || !tracer_update(session->tracer, &picture->job.packed)) {
        status = build_tracer(session, picture);
        *pipeline_ms = clock_ms() - start;
    }
    if (status != STATUS_DONE)
        return status;
    picture_release(&session->traced);
    session->traced = picture_share(picture);
    status = image_create(plan->window.width, plan->window.height, &picture->image);
    if (status == STATUS_DONE && plan->precision == PRECISION_DOUBLE)
        status = image_widen(&picture->image);
    progress_start(&progress, "rendering", (uint64_t)plan->window.width * plan->window.height, plan->quiet);
    if (status == STATUS_DONE)
        status =
            tracer_render(session->tracer, plan->window, &picture->image, &progress, &picture->dispatch_ms);
    progress_end(&progress);
    if (status != STATUS_DONE)
        drop_tracer(session);
    else if (session->options->window)
        status = session_show(session, &picture->image);
    return status;
}

enum status session_show(struct session *session, const struct image *image)
{
    enum status status = STATUS_DONE;
    if (!session->display)
        status = display_create(session->context, image->width, image->height, &session->display);
    uint8_t *rgba =
        status == STATUS_DONE ? display_picture(session->display, image->width, image->height) : NULL;
    if (!rgba)
        return STATUS_UNABLE;
    for (size_t i = 0; i < (size_t)image->width * image->height; ++i) {
        if (session->options->transfer == TRANSFER_SRGB)
            srgb_encode(&session->encoder, image->rgb + 3 * i, 3, rgba + 4 * i);
        else
            linear_encode(image->rgb + 3 * i, 3, rgba + 4 * i);
    }
    return display_paint(session->display);
}

void session_render(struct session *session, double saved_ms)
{
    double compile_ms, pipeline_ms = 0;
    struct picture *picture = prepare(session, 1);
    if (!picture) {
        tell_failure(session, "scene refused", "see the terminal", 0);
        return;
    }
    const char *what = "compile failed", *details = "see the terminal";
    enum status status = compile(session, picture, &compile_ms);
    if (status == STATUS_REFUSED)
        details = session->messages;
    if (status == STATUS_DONE) {
        what = "rendering failed";
        compile_ms = 0;
        status = render(session, picture, &pipeline_ms);
        if (status == STATUS_DONE)
            status = job_write(&picture->job, &picture->image, session->options->outputs,
                               session->options->output_count, session->options->transfer,
                               session->context->properties.deviceName);
    }
    if (status == STATUS_DONE) {
        picture->number = session->shown ? session->shown->number + 1 : 1;
        picture_release(&session->shown);
        session->shown = picture_share(picture);
        session->failure[0] = 0;
        tell_success(picture, pipeline_ms, saved_ms);
        if (session->check)
            background_check_submit(session->check, picture);
    } else if (status == STATUS_REFUSED || status == STATUS_UNABLE) {
        tell_failure(session, what, details, compile_ms);
    }
    picture_release(&picture);
}

void session_take(struct session *session, double saved_ms)
{
    size_t length;
    char *text = inputs_read_scene(&session->inputs, &length);
    if (!inputs_hold(&session->inputs)) {
        free(text);
        return;
    }
    session->scene_changed = !text || !session->scene_text || strcmp(text, session->scene_text) != 0;
    free(session->scene_text);
    session->scene_text = text;
    session->scene_length = length;
    session_render(session, saved_ms);
}

void session_preview(struct session *session, unsigned reduction)
{
    double pipeline_ms, start = clock_ms();
    bool good = session->shown && !session->failure[0];
    struct picture *picture = good ? prepare(session, reduction) : NULL;
    if (picture && render(session, picture, &pipeline_ms) == STATUS_DONE)
        log_info("moving: every %u pixels in %.1f ms", reduction, clock_ms() - start);
    picture_release(&picture);
}

enum status session_destroy(struct session *session)
{
    background_check_destroy(&session->check);
    display_destroy(&session->display);
    drop_tracer(session);
    picture_release(&session->shown);
    inputs_destroy(&session->inputs);
    free(session->code);
    free(session->messages);
    free(session->scene_text);
    return vulkan_context_destroy(&session->context);
}
