#include "command_watch.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "background_check.h"
#include "live_shader.h"
#include "outputs.h"
#include "probe.h"
#include "scene_text.h"
#include "shader_folder.h"
#include "watch_inputs.h"

static const double patience_ms = 250; /* between looks at Ctrl-C, should another thread have been told */

struct watching {
    const struct options *options;
    struct watch_inputs inputs;
    struct live_shader live;
    bool shader_changed;            /* since it was compiled */
    struct background_check *check; /* NULL without --check */
    struct picture *wanted;         /* the scene as the file says it now; NULL: it is refused */
    struct picture *shown;          /* the last good picture; NULL: none yet */
};

/* Says that the picture on show is not what the files say. */
static void tell_failure(const struct watching *watching, const char *what, double milliseconds)
{
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
        snprintf(pipeline, sizeof pipeline, "pipeline %s in %.1f ms", picture->number > 1 ? "rebuilt" : "built",
                 pipeline_ms);
    log_notice("picture %u: %s, rendered in %.1f ms, %.1f ms from save to picture", picture->number, pipeline,
               picture->dispatch_ms, clock_ms() - saved_ms);
}

static enum status read_scene(struct watching *watching)
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
    watching->wanted = picture_create();
    status =
        watching->wanted ? job_create_from(watching->options, &scene, &watching->wanted->job) : STATUS_UNABLE;
    if (status != STATUS_DONE)
        picture_release(&watching->wanted);
    scene_destroy(&scene);
    return status;
}

/* Renders what is wanted and shows it. */
static enum status renew_picture(struct watching *watching, double saved_ms)
{
    struct picture *picture = watching->wanted;
    double pipeline_ms;
    image_destroy(&picture->image);
    enum status status = live_shader_render(&watching->live, picture, &pipeline_ms);
    if (status == STATUS_DONE)
        status = outputs_write(watching->options, &picture->job, &picture->image,
                               watching->live.context->properties.deviceName);
    if (status == STATUS_INTERRUPTED)
        return status;
    if (status != STATUS_DONE) {
        tell_failure(watching, "rendering failed", 0);
        return status;
    }
    picture->number = watching->shown ? watching->shown->number + 1 : 1;
    picture_release(&watching->shown);
    watching->shown = picture_share(picture);
    tell_success(picture, pipeline_ms, saved_ms);
    if (watching->check)
        background_check_submit(watching->check, picture);
    return STATUS_DONE;
}

/* One turn: from changed files to a new picture or to the reason why there is none. */
static enum status follow(struct watching *watching, double saved_ms)
{
    double compile_ms;
    enum status status = read_scene(watching);
    if (status != STATUS_DONE) {
        tell_failure(watching, "scene refused", 0);
        return status;
    }
    status = live_shader_compile(&watching->live, watching->wanted, &watching->inputs.shader,
                                 watching->shader_changed, &compile_ms);
    watching->shader_changed = false;
    if (status == STATUS_REFUSED)
        tell_failure(watching, "compile failed", compile_ms);
    return status == STATUS_DONE ? renew_picture(watching, saved_ms) : status;
}

/* Files that are not there at all are a mistake on the command line, not one to be corrected in an editor. */
static enum status check_first_reading(const struct watch_inputs *inputs)
{
    if (!inputs->scene) {
        fprintf(stderr, "%s: error: %s\n", inputs->scene_path, strerror(inputs->scene_error));
        return STATUS_REFUSED;
    }
    if (access(inputs->shader_path, R_OK) == 0)
        return STATUS_DONE;
    log_error("%s: %s; --shaders names the folder of whitted.comp", inputs->shader_path, strerror(errno));
    return STATUS_REFUSED;
}

static enum status watch(struct watching *watching)
{
    struct watch_changes changes;
    double start = clock_ms();
    enum status status = watch_inputs_read(&watching->inputs, false, &changes);
    if (status == STATUS_DONE)
        status = check_first_reading(&watching->inputs);
    if (status != STATUS_DONE)
        return status;
    changes.saved_ms = start;
    while (!interrupt_requested()) {
        if (changes.scene || changes.shader) {
            watching->shader_changed |= changes.shader;
            if (follow(watching, changes.saved_ms) == STATUS_INTERRUPTED)
                break;
        }
        bool happened = file_watch_wait(watching->inputs.files, patience_ms);
        status = watch_inputs_read(&watching->inputs, happened, &changes);
        if (status != STATUS_DONE)
            return status;
    }
    return STATUS_DONE;
}

static enum status open_device(struct watching *watching)
{
    struct live_shader *live = &watching->live;
    enum status status = vulkan_context_create(&watching->options->vulkan, &live->context);
    if (status != STATUS_DONE)
        return status;
    live->options = (struct tracer_options){
        .double_precision = watching->options->precision == PRECISION_DOUBLE,
        .fast = watching->options->fast,
    };
    if (!watching->options->fast)
        status = probe_require_exact(live->context);
    return status;
}

enum status command_watch(const struct options *options)
{
    struct watching watching = {.options = options};
    char *shader_path = shader_file_path(options->shaders);
    enum status status = shader_path ? outputs_check(options) : STATUS_UNABLE;
    if (status == STATUS_DONE)
        status = watch_inputs_create(options->scenes[0], shader_path, &watching.inputs);
    if (status == STATUS_DONE)
        status = shader_compiler_create(&watching.live.compiler);
    if (status == STATUS_DONE)
        status = open_device(&watching);
    if (status == STATUS_DONE && options->check)
        status = background_check_create(&watching.check);
    if (status == STATUS_DONE)
        status = watch(&watching);
    background_check_destroy(&watching.check);
    struct vulkan_context *context = watching.live.context;
    shader_compiler_destroy(&watching.live.compiler);
    live_shader_destroy(&watching.live);
    enum status closed = vulkan_context_destroy(&context);
    picture_release(&watching.wanted);
    picture_release(&watching.shown);
    watch_inputs_destroy(&watching.inputs);
    free(shader_path);
    return status == STATUS_DONE ? closed : status;
}
