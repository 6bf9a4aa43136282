#include "tracer/tracer.h"

#include <stdlib.h>
#include <string.h>

#include "tracer/shader_folder.h"
#include "tracer/tiles.h"
#include "vulkan/probe.h"

struct shader_choice tracer_shader(const struct vulkan_context *context, const struct packed_scene *scene,
                                   const struct tracer_options *options)
{
    enum whitted_variant variant = options->double_precision                ? WHITTED_DOUBLE
                                   : options->fast                          ? WHITTED_FAST
                                   : needs_correction(&context->arithmetic) ? WHITTED_CORRECTED
                                                                            : WHITTED_EXACT;
    return (struct shader_choice){
        .variant = options->event_room > 0 ? WHITTED_EXACT_EVENTS + variant : variant,
        .scene_in_storage = scene_needs_storage(context, scene),
    };
}

enum status tracer_create(struct vulkan_context *context, const struct packed_scene *scene,
                          const struct tracer_options *options, struct tracer **pointer)
{
    struct tracer *tracer = *pointer = calloc(1, sizeof *tracer);
    if (!tracer) {
        log_error("no memory for the tracer");
        return STATUS_UNABLE;
    }
    struct dispatcher *dispatcher = &tracer->dispatcher;
    *dispatcher = (struct dispatcher){
        .context = context,
        .scene = scene,
        .options = *options,
    };
    enum status status = options->fast ? STATUS_DONE : probe_require_exact(context);
    if (status == STATUS_DONE && options->double_precision && !context->has_float64) {
        log_error("%s has no double precision (shaderFloat64)", context->properties.deviceName);
        status = STATUS_UNABLE;
    }
    dispatcher->choice = tracer_shader(context, scene, options);
    if (status == STATUS_DONE && options->shaders)
        status = shader_folder_code(options->shaders, dispatcher->choice, &dispatcher->options.code);
    if (status == STATUS_DONE)
        status = dispatcher_create(dispatcher);
    tracer->pixels = dispatcher->size.tile_pixels;
    tracer->turns = dispatcher->size.most_turns;
    if (status != STATUS_DONE)
        tracer_destroy(pointer);
    return status;
}

void tracer_destroy(struct tracer **pointer)
{
    struct tracer *tracer = *pointer;
    *pointer = NULL;
    if (!tracer)
        return;
    tiles_destroy(tracer);
    dispatcher_destroy(&tracer->dispatcher);
    free(tracer);
}

bool tracer_update(struct tracer *tracer, const struct packed_scene *scene)
{
    struct dispatcher *dispatcher = &tracer->dispatcher;
    const struct specialization built = dispatcher_specialization(dispatcher, dispatcher->scene),
                                needed = dispatcher_specialization(dispatcher, scene);
    if (memcmp(&built, &needed, sizeof built) != 0 ||
        !scene_buffer_update(&dispatcher->scene_buffer, dispatcher->scene, scene))
        return false;
    dispatcher->scene = scene;
    return true;
}

enum status tracer_render(struct tracer *tracer, struct window window, const struct tracer_values *values,
                          struct progress *progress, struct tracer_times *times)
{
    return tiles_render(tracer, window, values, progress, times);
}

uint32_t tracer_events(const struct tracer *tracer, const void **events)
{
    const struct event_block *block = tracer->frames[0].buffers[EVENTS].mapped;
    *events = block + 1;
    return block->count;
}
