#include "pixel/ray_tree.h"

#include <stdlib.h>

/* Events that are kept, 170 MB: beyond that nobody reads. */
enum { MOST_EVENTS = 1 << 20 };

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static enum status allocate(struct ray_tree *tree, size_t took_place, size_t kept)
{
    tree->count = smaller(took_place, kept);
    tree->beyond = took_place - tree->count;
    tree->events = calloc(tree->count + 1, sizeof *tree->events);
    if (tree->events)
        return STATUS_DONE;
    log_error("no memory for %zu events", tree->count);
    *tree = (struct ray_tree){0};
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

static void widen(const void *source, bool double_precision, struct ray_tree *tree)
{
    const struct float_event *floats = source;
    const struct double_event *doubles = source;
    for (size_t i = 0; i < tree->count; ++i) {
        struct reference_event *event = &tree->events[i];
        event->head = double_precision ? doubles[i].head : floats[i].head;
        for (int k = 0; k < EVENT_VALUES; ++k)
            event->values[k] = double_precision ? doubles[i].values[k] : (double)floats[i].values[k];
    }
}

/* Renders the pixel with a tracer that records. */
static enum status record(struct tracer *tracer, const struct render_plan *plan)
{
    const struct window pixel = {plan->window.x, plan->window.y, 1, 1};
    struct image image;
    struct progress progress;
    double unused_ms;
    enum status status = image_create(1, 1, &image);
    if (status != STATUS_DONE)
        return status;
    progress_start(&progress, "tracing", 1, plan->quiet);
    status = tracer_render(tracer, pixel, &image, &progress, &unused_ms);
    progress_end(&progress);
    image_destroy(&image);
    return status;
}

enum status ray_tree_on_device(struct vulkan_context *context, const struct render_plan *plan,
                               size_t expected, struct ray_tree *tree)
{
    const bool double_precision = plan->precision == PRECISION_DOUBLE;
    const size_t fitting = context->properties.limits.maxStorageBufferRange / sizeof(struct double_event) - 1;
    const size_t kept = smaller(smaller(expected, MOST_EVENTS), fitting);
    struct tracer *tracer;
    *tree = (struct ray_tree){0};
    enum status status = tracer_create(
        context, plan->scene,
        &(struct tracer_options){.double_precision = double_precision, .event_room = (uint32_t)kept},
        &tracer);
    if (status != STATUS_DONE)
        return status;
    status = record(tracer, plan);
    if (status == STATUS_DONE) {
        const void *source;
        status = allocate(tree, tracer_events(tracer, &source), kept);
        if (status == STATUS_DONE)
            widen(source, double_precision, tree);
    }
    tracer_destroy(&tracer);
    return status;
}

enum status ray_tree_on_cpu(const struct render_plan *plan, enum precision against, struct ray_tree *tree)
{
    void (*const trace)(const struct packed_scene *scene, int x, int y, struct reference_log *log) =
        against == PRECISION_QUAD             ? reference_analyse_quad
        : against == PRECISION_DOUBLE         ? reference_analyse_double
        : plan->precision == PRECISION_DOUBLE ? reference_record_double
                                              : reference_record_float;
    const int x = (int)plan->window.x, y = (int)plan->window.y;
    struct reference_log log = {0};
    trace(plan->scene, x, y, &log); /* counts */
    enum status status = allocate(tree, log.count, MOST_EVENTS);
    if (status != STATUS_DONE)
        return status;
    log = (struct reference_log){.events = tree->events, .room = tree->count};
    trace(plan->scene, x, y, &log);
    return STATUS_DONE;
}

void ray_tree_destroy(struct ray_tree *tree)
{
    free(tree->events);
    *tree = (struct ray_tree){0};
}
