#include "tracer/tracer.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "tracer/dispatch.h"
#include "tracer/shader_folder.h"
#include "vulkan/probe.h"

/* A dispatch should take about this long, so that progress is seen, no watchdog bites and starting it
 * costs little. */
static const double goal_ms = 50;

enum { FRAMES = 2 };

/* Renders pictures in tiles, of which two at most are under way. What it has learned of the device's speed
 * holds for the next picture. */
struct tracer {
    struct dispatcher dispatcher;
    struct dispatch_frame frames[FRAMES];
    unsigned frame_count, width, height; /* of the frames there are, and of their tiles at most */
    unsigned pixels;                     /* of a tile, at most */
    uint32_t turns;                      /* of a dispatch, at most */
};

/* A picture on its way: tiles from left to right and from top to bottom. */
struct course {
    struct tracer *tracer;
    struct window window;
    const struct tracer_values *values;
    struct progress *progress;
    uint64_t told[FRAMES];     /* samples of the frames' tiles, to the progress */
    unsigned x, y, row_height; /* of the next tile, in the window */
    double device_ms, end_ms;  /* of the dispatches so far */
};

static void destroy_frames(struct tracer *tracer)
{
    for (unsigned i = 0; i < tracer->frame_count; ++i)
        dispatch_frame_destroy(&tracer->dispatcher, &tracer->frames[i]);
    tracer->frame_count = 0;
}

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
    destroy_frames(tracer);
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

static unsigned smaller(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* Makes the frames that a window needs, or keeps those there are. A tile is as wide as the window, if it can
 * have a row of groups then. */
static enum status require_frames(struct tracer *tracer, const struct window *window)
{
    const struct dispatch_size *size = &tracer->dispatcher.size;
    const unsigned rows = smaller(size->group_height, window->height);
    unsigned width = smaller(window->width, size->tile_pixels / smaller(rows, size->tile_pixels));
    width = smaller(width, size->tile_groups * size->group_width * size->columns);
    unsigned height = smaller(window->height, size->tile_pixels / width);
    height = smaller(height, size->tile_groups / groups_across(size, width) * size->group_height);
    unsigned count = width < window->width || height < window->height ? FRAMES : 1;
    if (tracer->frame_count >= count && tracer->width >= width && tracer->height >= height)
        return STATUS_DONE;
    destroy_frames(tracer);
    tracer->width = width;
    tracer->height = height;
    enum status status = STATUS_DONE;
    while (tracer->frame_count < count && status == STATUS_DONE) {
        status =
            dispatch_frame_create(&tracer->dispatcher, width, height, &tracer->frames[tracer->frame_count]);
        tracer->frame_count += status == STATUS_DONE;
    }
    return status;
}

/* Copies a row of the finished tile to the pixels of the window from the place on. */
static void copy_row(const struct dispatch_frame *frame, enum value_type type, size_t first, size_t pixels,
                     size_t place, const struct tracer_values *to)
{
    const uint32_t *integers = (const uint32_t *)frame->values + CHANNELS * first;
    const float *floats = (const float *)frame->values + CHANNELS * first;
    const double *doubles = (const double *)frame->values + CHANNELS * first;
    const bool wide = type == VALUE_DOUBLE;
    for (size_t i = 0; to->signatures && i < pixels; ++i)
        to->signatures[place + i] = integers[CHANNELS * i + 2];
    if (!to->image)
        return;
    float *rgb = to->image->rgb + 3 * place;
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c)
            rgb[3 * i + c] = wide ? (float)doubles[CHANNELS * i + c] : floats[CHANNELS * i + c];
    for (size_t i = 0; to->image->rgb64 && wide && i < pixels; ++i)
        memcpy(to->image->rgb64 + 3 * (place + i), doubles + CHANNELS * i, 3 * sizeof *doubles);
    for (size_t i = 0; to->image->truncation && i < pixels; ++i)
        to->image->truncation[place + i] = wide ? (float)doubles[CHANNELS * i + 3] : floats[CHANNELS * i + 3];
}

/* Takes the values of the frame's tile, which is finished. */
static enum status take(struct course *course, struct dispatch_frame *frame)
{
    const struct dispatcher *dispatcher = &course->tracer->dispatcher;
    const struct portion *portion = &frame->portion;
    struct reference_rays *rays = course->values->rays;
    enum status status = dispatch_frame_fetch(dispatcher, frame);
    course->end_ms = clock_ms();
    if (status != STATUS_DONE)
        return status;
    const uint32_t *counts = frame->values;
    for (size_t i = 0; rays && i < (size_t)portion->tile_width * portion->tile_height; ++i) {
        rays->secondary += counts[CHANNELS * i];
        rays->shadow += counts[CHANNELS * i + 1];
    }
    const unsigned x = portion->tile_x - course->window.x, y = portion->tile_y - course->window.y;
#pragma omp parallel for if (frame->staging.buffer) /* otherwise the processors render the next tile */
    for (unsigned row = 0; row < portion->tile_height; ++row)
        copy_row(frame, dispatcher->value_type, (size_t)row * portion->tile_width, portion->tile_width,
                 (size_t)(y + row) * course->window.width + x, course->values);
    return STATUS_DONE;
}

static uint64_t samples_of(const struct course *course, uint64_t pixels)
{
    return pixels * (uint64_t)course->tracer->dispatcher.scene->samples;
}

static uint64_t tile_pixels(const struct dispatch_frame *frame)
{
    return (uint64_t)frame->portion.tile_width * frame->portion.tile_height;
}

static enum status start_next_tile(struct course *course, struct dispatch_frame *frame)
{
    const struct tracer *tracer = course->tracer;
    const struct dispatch_size *size = &tracer->dispatcher.size;
    const struct packed_scene *scene = tracer->dispatcher.scene;
    const unsigned rows = size->group_height;
    if (course->x == 0) {
        const unsigned left = course->window.height - course->y;
        const unsigned most =
            smaller(tracer->height, tracer->pixels / smaller(tracer->pixels, tracer->width));
        course->row_height = most >= left ? left : most > rows ? most - most % rows : most;
    }
    frame->portion = (struct portion){
        .tile_x = course->window.x + course->x,
        .tile_y = course->window.y + course->y,
        .tile_width = smaller(tracer->width, course->window.width - course->x),
        .tile_height = course->row_height,
        .picture_width = (uint32_t)scene->width,
        .picture_height = (uint32_t)scene->height,
        .most_turns = tracer->turns,
    };
    course->x += frame->portion.tile_width;
    if (course->x == course->window.width) {
        course->x = 0;
        course->y += course->row_height;
    }
    course->told[frame - tracer->frames] = 0;
    progress_begin(course->progress, samples_of(course, tile_pixels(frame)));
    return dispatch_frame_start(&tracer->dispatcher, frame);
}

/* Tells how many samples of the tile there are. */
static void tell(struct course *course, const struct dispatch_frame *frame, uint32_t unfinished)
{
    uint64_t *told = &course->told[frame - course->tracer->frames];
    const uint64_t samples = samples_of(course, tile_pixels(frame) - unfinished);
    progress_advance(course->progress, samples - *told);
    *told = samples;
}

/* More or less of a quantity, where a dispatch took too short or too long. */
static uint32_t adapted(uint32_t quantity, double took_ms, uint32_t least, uint32_t most)
{
    if (took_ms > 2 * goal_ms && quantity / 2 >= least)
        return quantity / 2;
    if (took_ms < goal_ms / 2)
        return quantity > most / 2 ? most : 2 * quantity;
    return quantity;
}

/* Waits for the frame, and has it go on with its tile if that is not finished. */
static enum status advance(struct course *course, struct dispatch_frame *frame)
{
    enum { LEAST_PIXELS = 4096 };
    struct tracer *tracer = course->tracer;
    const struct dispatch_size *size = &tracer->dispatcher.size;
    uint32_t unfinished;
    double device_ms = 0;
    enum status status = dispatch_frame_wait(&tracer->dispatcher, frame, &device_ms, &unfinished);
    course->device_ms += device_ms;
    if (status != STATUS_DONE)
        return status;
    tracer->turns = adapted(tracer->turns, device_ms, 1, size->most_turns);
    if (!frame->portion.goes_on)
        tracer->pixels = adapted(tracer->pixels, device_ms, LEAST_PIXELS, size->tile_pixels);
    tell(course, frame, unfinished);
    if (unfinished > 0) {
        frame->portion.goes_on = 1;
        frame->portion.most_turns = tracer->turns;
        return dispatch_frame_start(&tracer->dispatcher, frame);
    }
    return take(course, frame);
}

/* Has each frame render tiles until there are none left. */
static enum status run(struct course *course)
{
    struct tracer *tracer = course->tracer;
    enum status status = STATUS_DONE;
    bool under_way = true;
    while (status == STATUS_DONE && under_way) {
        under_way = false;
        for (unsigned i = 0; i < tracer->frame_count && status == STATUS_DONE; ++i) {
            struct dispatch_frame *frame = &tracer->frames[i];
            if (frame->under_way)
                status = advance(course, frame);
            if (status == STATUS_DONE && !frame->under_way && course->y < course->window.height)
                status = start_next_tile(course, frame);
            under_way = under_way || frame->under_way;
        }
    }
    return status;
}

enum status tracer_render(struct tracer *tracer, struct window window, const struct tracer_values *values,
                          struct progress *progress, struct tracer_times *times)
{
    struct course course = {.tracer = tracer, .window = window, .values = values, .progress = progress};
    *times = (struct tracer_times){0};
    if (values->rays)
        values->rays->primary +=
            (uint64_t)window.width * window.height * (uint64_t)tracer->dispatcher.scene->samples;
    enum status status = require_frames(tracer, &window);
    const double start = clock_ms();
    if (status == STATUS_DONE)
        status = run(&course);
    /* the other frame, after a failure */
    for (unsigned i = 0; i < tracer->frame_count; ++i)
        if (tracer->frames[i].under_way)
            dispatch_frame_wait(&tracer->dispatcher, &tracer->frames[i], NULL, &(uint32_t){0});
    *times = (struct tracer_times){.dispatch_ms = course.end_ms - start, .device_ms = course.device_ms};
    return status;
}

uint32_t tracer_events(const struct tracer *tracer, const void **events)
{
    const struct event_block *block = tracer->frames[0].buffers[EVENTS].mapped;
    *events = block + 1;
    return block->count;
}
