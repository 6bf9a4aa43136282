#include "pixel/events.h"

#include <stdlib.h>

/* Events that are kept, 170 MB: beyond that nobody reads. */
enum { MOST_EVENTS = 1 << 20 };

typedef void record_pixel(const struct packed_scene *scene, int x, int y, struct reference_log *log);

static enum status allocate(struct pixel_events *events, size_t took_place)
{
    events->count = took_place < MOST_EVENTS ? took_place : MOST_EVENTS;
    events->beyond = took_place - events->count;
    events->events = calloc(events->count + 1, sizeof *events->events);
    if (events->events)
        return STATUS_DONE;
    log_error("no memory for %zu events", events->count);
    *events = (struct pixel_events){0};
    return STATUS_UNABLE;
}

/* Events as the device leaves them; see shaders/events.glsl. */
struct float_event {
    struct EventHead head;
    float values[EVENT_VALUES];
};
struct double_event {
    struct EventHead head;
    double values[EVENT_VALUES];
};

static void widen(const void *source, bool double_precision, struct pixel_events *events)
{
    const struct float_event *floats = source;
    const struct double_event *doubles = source;
    for (size_t i = 0; i < events->count; ++i) {
        struct reference_event *event = &events->events[i];
        event->head = double_precision ? doubles[i].head : floats[i].head;
        for (int k = 0; k < EVENT_VALUES; ++k)
            event->values[k] = double_precision ? doubles[i].values[k] : (double)floats[i].values[k];
    }
}

/* So many fit in a buffer of the device. */
static uint32_t choose_room(const struct vulkan_context *context, size_t expected)
{
    size_t fitting = context->properties.limits.maxStorageBufferRange / sizeof(struct double_event) - 1;
    size_t room = expected < MOST_EVENTS ? expected : MOST_EVENTS;
    return (uint32_t)(room < fitting ? room : fitting);
}

enum status pixel_events_on_device(struct vulkan_context *context, const struct render_plan *plan,
                                   size_t room, struct pixel_events *events)
{
    *events = (struct pixel_events){0};
    const struct window pixel = {plan->window.x, plan->window.y, 1, 1};
    const uint32_t kept = choose_room(context, room);
    struct tracer *tracer;
    struct image image = {0};
    struct progress progress;
    double unused_ms;
    enum status status = tracer_create(context, plan->scene,
                                       &(struct tracer_options){
                                           .double_precision = plan->precision == PRECISION_DOUBLE,
                                           .event_room = kept,
                                       },
                                       &tracer);
    if (status != STATUS_DONE)
        return status;
    progress_start(&progress, "tracing", 1, plan->quiet);
    status = image_create(1, 1, &image);
    if (status == STATUS_DONE)
        status = tracer_render(tracer, pixel, &image, &progress, &unused_ms);
    progress_end(&progress);
    if (status == STATUS_DONE) {
        const void *source;
        size_t took_place = tracer_events(tracer, &source);
        status = allocate(events, took_place < kept ? took_place : kept);
        if (status == STATUS_DONE) {
            events->beyond = took_place - events->count;
            widen(source, plan->precision == PRECISION_DOUBLE, events);
        }
    }
    tracer_destroy(&tracer);
    image_destroy(&image);
    return status;
}

enum status pixel_events_on_cpu(const struct render_plan *plan, enum precision against,
                                struct pixel_events *events)
{
    record_pixel *record = against == PRECISION_QUAD             ? reference_analyse_quad
                           : against == PRECISION_DOUBLE         ? reference_analyse_double
                           : plan->precision == PRECISION_DOUBLE ? reference_record_double
                                                                 : reference_record_float;
    const int x = (int)plan->window.x, y = (int)plan->window.y;
    struct reference_log log = {0};
    record(plan->scene, x, y, &log); /* counts */
    enum status status = allocate(events, log.count);
    if (status != STATUS_DONE)
        return status;
    log = (struct reference_log){.events = events->events, .room = events->count};
    record(plan->scene, x, y, &log);
    return STATUS_DONE;
}

void pixel_events_destroy(struct pixel_events *events)
{
    free(events->events);
    *events = (struct pixel_events){0};
}
