#include "command_watch.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "outputs.h"
#include "probe.h"
#include "shader_folder.h"
#include "watch_view.h"

static const double patience_ms = 250; /* between looks at Ctrl-C, should another thread have been told */

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
        bool happened = file_watch_wait(watching->inputs.files, watching->window ? 0 : patience_ms);
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
    vulkan.presents = watching->options->window;
    enum status status = vulkan_context_create(&vulkan, &live->context);
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
    if (status == STATUS_DONE && (options->check || options->window))
        status = background_check_create(options->check, &watching.check);
    if (status == STATUS_DONE)
        status = watch(&watching);
    background_check_destroy(&watching.check);
    watch_window_destroy(&watching.window);
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
