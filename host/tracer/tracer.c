#include "tracer/tracer.h"

#include <stdlib.h>
#include <string.h>

#include "base/interrupt.h"
#include "tracer/dispatch.h"
#include "vulkan/probe.h"

struct tracer {
    struct vulkan_context *context;
    const struct packed_scene *scene;
    struct tracer_options options;
    struct shader_choice choice;
    struct scene_buffer scene_buffer;
    struct dispatcher dispatcher;
};

struct shader_choice tracer_shader(const struct vulkan_context *context, const struct packed_scene *scene,
                                   const struct tracer_options *options)
{
    static const enum whitted_variant with_events[] = {
        [WHITTED_EXACT] = WHITTED_EXACT_EVENTS,
        [WHITTED_CORRECTED] = WHITTED_CORRECTED_EVENTS,
        [WHITTED_DOUBLE] = WHITTED_DOUBLE_EVENTS,
        [WHITTED_FAST] = WHITTED_FAST, /* which records none */
    };
    bool native = context->arithmetic.division_exact && context->arithmetic.root_exact;
    enum whitted_variant variant = options->double_precision ? WHITTED_DOUBLE
                                   : options->fast           ? WHITTED_FAST
                                   : native                  ? WHITTED_EXACT
                                                             : WHITTED_CORRECTED;
    return (struct shader_choice){
        .variant = options->event_room > 0 ? with_events[variant] : variant,
        .scene_in_storage = scene_needs_storage(context, scene),
    };
}

static struct specialization constants_of(const struct tracer *tracer, const struct packed_scene *scene,
                                          const struct dispatch_size *size)
{
    const struct arithmetic *arithmetic = &tracer->context->arithmetic;
    struct specialization constants = specialize(scene, &size->shape, tracer->options.output);
    constants.corrected_division = !arithmetic->division_exact;
    constants.corrected_root = !arithmetic->root_exact;
    /* lavapipe's limit is 65535; what is left is for loops of the driver's own making */
    constants.turn_limit =
        tracer->context->driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE ? 65000 : UINT32_MAX;
    constants.resumable = size->stack_room > 0;
    return constants;
}

static enum status create_dispatcher(const struct tracer *tracer, struct dispatch_size size,
                                     struct dispatcher *dispatcher)
{
    const struct shader_choice *choice = &tracer->choice;
    const struct dispatcher_info info = {
        .scene = &tracer->scene_buffer,
        .scene_in_storage = choice->scene_in_storage,
        .code = tracer->options.code.words ? tracer->options.code
                                           : whitted_spirv(choice->variant, choice->scene_in_storage),
        .constants = constants_of(tracer, tracer->scene, &size),
        .size = size,
        .double_precision = tracer->options.double_precision,
        .event_room = tracer->options.event_room,
    };
    return dispatcher_create(tracer->context, &info, dispatcher);
}

enum status tracer_create(struct vulkan_context *context, const struct packed_scene *scene,
                          const struct tracer_options *options, struct tracer **pointer)
{
    struct tracer *tracer = *pointer = calloc(1, sizeof *tracer);
    if (!tracer) {
        log_error("no memory for the tracer");
        return STATUS_UNABLE;
    }
    *tracer = (struct tracer){.context = context, .scene = scene, .options = *options};
    enum status status = options->fast ? STATUS_DONE : probe_require_exact(context);
    if (status == STATUS_DONE && options->double_precision && !context->has_float64) {
        log_error("%s has no double precision (shaderFloat64)", context->properties.deviceName);
        status = STATUS_UNABLE;
    }
    tracer->choice = tracer_shader(context, scene, options);
    if (status == STATUS_DONE)
        status = scene_buffer_create(context, scene, &tracer->scene_buffer);
    if (status == STATUS_DONE)
        status = create_dispatcher(tracer, dispatch_size_choose(context, scene), &tracer->dispatcher);
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
    dispatcher_destroy(&tracer->dispatcher);
    vulkan_buffer_destroy(tracer->context, &tracer->scene_buffer.buffer);
    free(tracer);
}

bool tracer_update(struct tracer *tracer, const struct packed_scene *scene)
{
    const struct specialization built = constants_of(tracer, tracer->scene, &tracer->dispatcher.size);
    const struct specialization needed = constants_of(tracer, scene, &tracer->dispatcher.size);
    if (memcmp(&built, &needed, sizeof built) != 0)
        return false;
    scene_buffer_update(&tracer->scene_buffer, scene);
    tracer->scene = scene;
    return true;
}

/* From now on ray trees may take several dispatches. On failure the tracer stays as it was. */
static enum status become_resumable(struct tracer *tracer)
{
    struct dispatcher resumable;
    enum status status = create_dispatcher(
        tracer, dispatch_size_resumable(tracer->dispatcher.size, tracer->scene), &resumable);
    if (status != STATUS_DONE)
        return status;
    dispatcher_destroy(&tracer->dispatcher);
    tracer->dispatcher = resumable;
    return STATUS_DONE;
}

/* Adds what the last dispatch has traced in so many pixels; the values do not tell the primary rays. No count
 * wraps around: 2^32 rays would take the pixel's invocation minutes, and a driver ends it before, lavapipe
 * after 65535 turns of its loops, a graphics card's after some seconds. */
static void add_rays(const struct dispatcher *dispatcher, size_t pixels, struct reference_rays *rays)
{
    const uint32_t *counts = dispatcher->values;
    for (size_t i = 0; i < pixels; ++i) {
        rays->secondary += counts[CHANNELS * i + 1];
        rays->shadow += counts[CHANNELS * i + 2];
    }
}

/* Renders the tile's samples, a part of them at a time. *too_long: the driver may have ended loops early. */
static enum status render_tile(struct tracer *tracer, struct window tile, struct reference_rays *rays,
                               double *dispatch_ms, bool *too_long)
{
    const struct packed_scene *scene = tracer->scene;
    const size_t pixels = (size_t)tile.width * tile.height;
    const uint32_t samples = (uint32_t)scene->samples, most = tracer->dispatcher.size.samples;
    enum status status = STATUS_DONE;
    *too_long = false;
    for (uint32_t first = 0, end; first < samples && status == STATUS_DONE && !*too_long; first = end) {
        end = samples - first < most ? samples : first + most;
        struct portion portion = {
            tile.x, tile.y, tile.width, tile.height, (uint32_t)scene->width, (uint32_t)scene->height,
            first,  end,    0,
        };
        double mark = 0;
        do {
            status = interrupt_requested() ? STATUS_INTERRUPTED
                                           : dispatcher_run(&tracer->dispatcher, &portion, dispatch_ms);
            if (status != STATUS_DONE)
                return status;
            mark = dispatcher_mark(&tracer->dispatcher, pixels);
            if (rays)
                add_rays(&tracer->dispatcher, pixels, rays);
            portion.goes_on = 1;
        } while (mark == UNFINISHED);
        if (rays)
            rays->primary += pixels * (end - first);
        *too_long = mark <= TOO_LONG;
    }
    return status;
}

/* Copies a row of the finished tile to the pixels of the window from the place on. */
static void copy_row(const struct dispatcher *dispatcher, size_t first, size_t pixels, size_t place,
                     const struct tracer_values *values)
{
    const uint32_t *integers = dispatcher->values;
    const float *floats = dispatcher->values;
    const double *doubles = dispatcher->values;
    for (size_t i = 0; values->signatures && i < pixels; ++i)
        values->signatures[place + i] = integers[CHANNELS * (first + i) + 1];
    if (!values->image)
        return;
    float *rgb = values->image->rgb + CHANNELS * place;
    const size_t count = CHANNELS * pixels;
    if (dispatcher->value_type == VALUE_FLOAT) {
        memcpy(rgb, floats + CHANNELS * first, count * sizeof *rgb);
        return;
    }
    for (size_t i = 0; i < count; ++i)
        rgb[i] = (float)doubles[CHANNELS * first + i];
    if (values->image->rgb64)
        memcpy(values->image->rgb64 + CHANNELS * place, doubles + CHANNELS * first, count * sizeof *doubles);
}

static enum status render_tiles(struct tracer *tracer, struct window window,
                                const struct tracer_values *values, struct progress *progress,
                                double *dispatch_ms, bool *too_long)
{
    /* an invocation traces all its rows, also those below the tile: whole ones, if possible */
    const unsigned rows = tracer->dispatcher.size.shape.rows, most = tracer->dispatcher.size.tile_pixels;
    unsigned tile_width = window.width < 1024 ? window.width : 1024;
    if (tile_width > most / rows)
        tile_width = most > rows ? most / rows : 1;
    unsigned tile_height = most / tile_width;
    tile_height -= tile_height > rows ? tile_height % rows : 0;
    *dispatch_ms = 0;
    if (values->rays)
        *values->rays = (struct reference_rays){0};
    for (unsigned y = 0; y < window.height; y += tile_height) {
        for (unsigned x = 0; x < window.width; x += tile_width) {
            struct window tile = {
                .x = window.x + x,
                .y = window.y + y,
                .width = window.width - x < tile_width ? window.width - x : tile_width,
                .height = window.height - y < tile_height ? window.height - y : tile_height,
            };
            enum status status = render_tile(tracer, tile, values->rays, dispatch_ms, too_long);
            if (status != STATUS_DONE || *too_long)
                return status;
            for (unsigned row = 0; row < tile.height; ++row)
                copy_row(&tracer->dispatcher, (size_t)row * tile.width, tile.width,
                         (size_t)(y + row) * window.width + x, values);
            progress_advance(progress, (uint64_t)tile.width * tile.height);
        }
    }
    return STATUS_DONE;
}

enum status tracer_render_values(struct tracer *tracer, struct window window,
                                 const struct tracer_values *values, struct progress *progress,
                                 double *dispatch_ms)
{
    uint64_t done = progress->done;
    bool too_long = false;
    enum status status = render_tiles(tracer, window, values, progress, dispatch_ms, &too_long);
    if (status == STATUS_DONE && too_long && tracer->dispatcher.size.stack_room == 0) {
        log_info("the driver may have ended loops early; going on in smaller portions");
        progress->done = done;
        status = become_resumable(tracer);
        if (status == STATUS_DONE)
            status = render_tiles(tracer, window, values, progress, dispatch_ms, &too_long);
    }
    if (status != STATUS_DONE || !too_long)
        return status;
    log_error("%s ends the shader's loops after 65535 turns, too early for so many light samples",
              tracer->context->properties.deviceName);
    return STATUS_UNABLE;
}

enum status tracer_render(struct tracer *tracer, struct window window, struct image *image,
                          struct progress *progress, double *dispatch_ms)
{
    return tracer_render_values(tracer, window, &(struct tracer_values){.image = image}, progress,
                                dispatch_ms);
}

uint32_t tracer_events(const struct tracer *tracer, const void **events)
{
    const struct event_block *block = tracer->dispatcher.events.mapped;
    *events = block + 1;
    return block->count;
}
