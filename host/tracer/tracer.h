#ifndef VKWHITTED_TRACER_TRACER_H
#define VKWHITTED_TRACER_TRACER_H

#include "base/progress.h"
#include "image/image.h"
#include "reference.h"
#include "tracer/interface.h"
#include "vulkan/context.h"

/* The compute pipeline for one packed scene, specialised to it. */
struct tracer;

/* Which of the shader's variants a tracer needs, on a device whose arithmetic is known. */
struct shader_choice tracer_shader(const struct vulkan_context *context, const struct packed_scene *scene,
                                   const struct tracer_options *options);

/* Builds the pipeline and uploads the scene, which must outlive the tracer. On failure (reported) *tracer is
 * NULL. */
enum status tracer_create(struct vulkan_context *context, const struct packed_scene *scene,
                          const struct tracer_options *options, struct tracer **tracer);
void tracer_destroy(struct tracer **tracer);

/* Gives the tracer another scene, which must outlive it in the place of the old one, if the pipeline is also
 * right for that: if no number of things and no feature is different. Otherwise returns false and changes
 * nothing. */
bool tracer_update(struct tracer *tracer, const struct packed_scene *scene);

/* Where a window's values go; NULL: nowhere. With tracer_options.counts that is the last two. */
struct tracer_values {
    struct image *image; /* of the window's size; gets the values in double precision and the charges, if it
                          * has room */
    struct reference_rays *rays; /* the window's are added */
    uint32_t *signatures;        /* a pixel each */
};

/* How long a picture took, in milliseconds: from the first submission to the last completion, and on the
 * device by its own timestamps (where it has none, as the first). */
struct tracer_times {
    double dispatch_ms, device_ms;
};

/* Renders the window of the picture. Advances progress, whose unit is a sample of a pixel. A failure
 * (reported) leaves the pipeline as it was. */
enum status tracer_render(struct tracer *tracer, struct window window, const struct tracer_values *values,
                          struct progress *progress, struct tracer_times *times);

/* The events of the pixel that was rendered last, in a window of its own, in the tracer's memory: EventHead
 * of scene_layout.h and EVENT_VALUES float or double each. The number of those that took place; of these
 * tracer_options.event_room at most are there. */
uint32_t tracer_events(const struct tracer *tracer, const void **events);

#endif
