#include "watch/watch.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "vulkan/probe.h"
#include "watch/shader_folder.h"
#include "watch/view.h"
#include "watch/window_system.h"

static const double look_again_ms = 250; /* for Ctrl-C, should another thread have been told of it */

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

static enum status follow(struct watching *watching)
{
    struct watch_changes changes;
    struct watch_view view = {0};
    bool closed = false;
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
            view.shows_difference = false;
            if (watch_turn(watching, changes.saved_ms) == STATUS_INTERRUPTED)
                break;
        }
        if (watching->options->window && !watching->window) /* there is something to say, but no picture */
            status = watch_window_create(watching->live.context, 600, 400, &watching->window);
        if (status == STATUS_DONE && watching->window)
            status = watch_view_follow(&view, watching, &closed);
        if (status != STATUS_DONE)
            return status;
        if (closed)
            break;
        bool happened = file_watch_wait(watching->inputs.files, watching->window ? 0 : look_again_ms);
        status = watch_inputs_read(&watching->inputs, happened, &changes);
        if (status != STATUS_DONE)
            return status;
    }
    return STATUS_DONE;
}

static enum status open_device(struct watching *watching)
{
    struct live_shader *live = &watching->live;
    struct vulkan_options vulkan = watching->options->vulkan;
    enum status status = STATUS_DONE;
    if (watching->options->window)
        status = window_system_open(&vulkan);
    if (status == STATUS_DONE)
        status = vulkan_context_create(&vulkan, &live->context);
    if (status != STATUS_DONE)
        return status;
    live->options = (struct tracer_options){
        .double_precision = watching->options->job.precision == PRECISION_DOUBLE,
        .fast = watching->options->job.fast,
    };
    if (!watching->options->job.fast)
        status = probe_require_exact(live->context);
    return status;
}

enum status watch(const struct watch_options *options)
{
    struct watching watching = {.options = options};
    char *shader_path = shader_file_path(options->shader_folder);
    enum status status = shader_path ? STATUS_DONE : STATUS_UNABLE;
    if (status == STATUS_DONE)
        status = watch_inputs_create(options->scene, shader_path, &watching.inputs);
    if (status == STATUS_DONE)
        status = shader_compiler_create(&watching.live.compiler);
    if (status == STATUS_DONE)
        status = open_device(&watching);
    if (status == STATUS_DONE && (options->check || options->window))
        status = background_check_create(options->check, &watching.check);
    if (status == STATUS_DONE)
        status = follow(&watching);
    background_check_destroy(&watching.check);
    watch_window_destroy(&watching.window);
    struct vulkan_context *context = watching.live.context;
    shader_compiler_destroy(&watching.live.compiler);
    live_shader_destroy(&watching.live);
    enum status closed = vulkan_context_destroy(&context);
    if (options->window)
        window_system_close();
    picture_release(&watching.wanted);
    picture_release(&watching.shown);
    watch_inputs_destroy(&watching.inputs);
    free(shader_path);
    return status == STATUS_DONE ? closed : status;
}
