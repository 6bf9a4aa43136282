#include "pixel/ray_tree.h"

#include <stdlib.h>
#include <sys/param.h>

#include "tracer/reference_scene.h"

/* Events that are kept, 170 MB: beyond that nobody reads. */
enum { MOST_EVENTS = 1 << 20 };

static enum status allocate(struct ray_tree *tree, size_t took_place, size_t kept)
{
    tree->count = MIN(took_place, kept);
    tree->beyond = took_place - tree->count;
    tree->events = calloc(tree->count + 1, sizeof *tree->events);
    if (tree->events)
        return STATUS_DONE;
    log_error("no memory for %zu events", tree->count);
    *tree = (struct ray_tree){0};
    return STATUS_UNABLE;
}

/* Copies events as the device leaves them; see shaders/events.glsl. */
static void copy_events(const void *source, bool double_precision, struct ray_tree *tree)
{
    const size_t value_size = double_precision ? sizeof(double) : sizeof(float);
    for (size_t i = 0; i < tree->count; ++i) {
        const struct EventHead *head =
            (const void *)((const char *)source + i * (sizeof *head + EVENT_VALUES * value_size));
        const void *values = head + 1;
        tree->events[i].head = *head;
        for (int k = 0; k < EVENT_VALUES; ++k)
            tree->events[i].values[k] =
                double_precision ? ((const double *)values)[k] : (double)((const float *)values)[k];
    }
}

enum status ray_tree_on_device(struct vulkan_context *context, const struct render_plan *plan,
                               size_t expected, struct ray_tree *tree)
{
    const bool double_precision = plan->precision == PRECISION_DOUBLE;
    const size_t event_size = sizeof(struct EventHead) + EVENT_VALUES * sizeof(double);
    const size_t fitting = context->properties.limits.maxStorageBufferRange / event_size - 1;
    const size_t kept = MIN(MIN(expected, MOST_EVENTS), fitting);
    const struct tracer_options options = {
        .double_precision = double_precision, .event_room = (uint32_t)kept, .shaders = plan->shaders};
    struct progress unseen = {.total = 1};
    struct tracer *tracer = NULL;
    struct image image;
    struct tracer_times unused;
    const void *events;
    *tree = (struct ray_tree){0};
    enum status status = image_create(1, 1, &image);
    if (status == STATUS_DONE)
        status = tracer_create(context, plan->scene, &options, &tracer);
    if (status == STATUS_DONE)
        status = tracer_render(tracer, (struct window){plan->window.x, plan->window.y, 1, 1},
                               &(struct tracer_values){.image = &image}, &unseen, &unused);
    if (status == STATUS_DONE)
        status = allocate(tree, tracer_events(tracer, &events), kept);
    if (status == STATUS_DONE)
        copy_events(events, double_precision, tree);
    tracer_destroy(&tracer);
    image_destroy(&image);
    return status;
}

/* Traces the pixel, in the plan's precision or with the error analysis. */
static void trace(const struct render_plan *plan, const struct packed_scene *scene, enum precision against,
                  struct reference_log *log)
{
    const int x = (int)plan->window.x, y = (int)plan->window.y;
    if (against == PRECISION_QUAD)
        reference_explain_quad(scene, x, y, log);
    else if (against == PRECISION_DOUBLE)
        reference_explain_double(scene, x, y, log);
    else if (plan->precision == PRECISION_DOUBLE)
        reference_trace_double(scene, x, y, log);
    else
        reference_trace_float(scene, x, y, log);
}

enum status ray_tree_on_cpu(const struct render_plan *plan, enum precision against, struct ray_tree *tree)
{
    struct reference_log log = {0};
    struct packed_scene scene;
    *tree = (struct ray_tree){0};
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    if (status != STATUS_DONE)
        return status;
    trace(plan, &scene, against, &log); /* counts */
    status = allocate(tree, log.count, MOST_EVENTS);
    if (status == STATUS_DONE) {
        log = (struct reference_log){.events = tree->events, .room = tree->count};
        trace(plan, &scene, against, &log);
    }
    return status;
}

void ray_tree_destroy(struct ray_tree *tree)
{
    free(tree->events);
    *tree = (struct ray_tree){0};
}
