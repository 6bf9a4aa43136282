#ifndef VKWHITTED_PIXEL_EVENTS_H
#define VKWHITTED_PIXEL_EVENTS_H

#include "reference_events.h"
#include "tracer/render.h"

/* What one side tells of a pixel, in the order of the recursion. */
struct pixel_events {
    struct reference_event *events;
    size_t count;
    size_t beyond; /* more took place, and are not here */
};

/* Traces the first pixel of plan->window in the plan's precision, with the picture's own pipeline but for the
 * recording; room: so many events are expected. The caller frees the events with pixel_events_destroy(). On
 * failure (reported) there are none. */
enum status pixel_events_on_device(struct vulkan_context *context, const struct render_plan *plan,
                                   size_t room, struct pixel_events *events);

/* The same with the reference (against: PRECISION_FLOAT), or the error analysis at higher precision. */
enum status pixel_events_on_cpu(const struct render_plan *plan, enum precision against,
                                struct pixel_events *events);

void pixel_events_destroy(struct pixel_events *events);

#endif
