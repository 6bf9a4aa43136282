#ifndef VKWHITTED_PIXEL_RAY_TREE_H
#define VKWHITTED_PIXEL_RAY_TREE_H

#include "reference_events.h"
#include "tracer/render.h"

/* The ray tree of a pixel as one side tells it: its events, in the order of the recursion. */
struct ray_tree {
    struct reference_event *events;
    size_t count;
    size_t beyond; /* more took place, and are not here */
};

/* Traces the first pixel of plan->window in the plan's precision, with the picture's own pipeline but for the
 * recording; so many events are expected. The caller frees the tree with ray_tree_destroy(). On failure
 * (reported) it is empty. */
enum status ray_tree_on_device(struct vulkan_context *context, const struct render_plan *plan,
                               size_t expected, struct ray_tree *tree);

/* The same with the reference (against: PRECISION_FLOAT), or the error analysis at higher precision. */
enum status ray_tree_on_cpu(const struct render_plan *plan, enum precision against, struct ray_tree *tree);

void ray_tree_destroy(struct ray_tree *tree);

#endif
