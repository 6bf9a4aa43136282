#ifndef VKWHITTED_TRACER_TRACER_H
#define VKWHITTED_TRACER_TRACER_H

#include "base/progress.h"
#include "image/image.h"
#include "packed_scene.h"
#include "tracer/whitted_spirv.h"
#include "vulkan/context.h"

/* The compute pipeline for one packed scene, specialised to it. */
struct tracer;

struct tracer_options {
    bool double_precision;              /* exact mode only, on a device with fp64 */
    bool fast;                          /* contraction and built-in functions allowed */
    int output;                         /* OUTPUT_ of scene_layout.h */
    unsigned group_width, group_height; /* invocations; 0: a choice that suits the device */
    unsigned tile_pixels;               /* most pixels a dispatch; 0: likewise */
    uint32_t event_room;                /* 0: no events are recorded; exact mode only */
    struct spirv code; /* of the shader that tracer_shader() tells; empty: the built-in one */
};

/* Which of the shader's variants a tracer needs, on a device whose arithmetic is known. */
struct shader_choice {
    enum whitted_variant variant;
    bool scene_in_storage;
};
struct shader_choice tracer_shader(const struct vulkan_context *context, const struct packed_scene *scene,
                                   const struct tracer_options *options);

/* Part of the picture, in pixels from the top left. */
struct window {
    unsigned x, y, width, height;
};

/* Whether the code, which is valid, uses no other buffers than a tracer provides: drivers crash otherwise. If
 * not, problem says what is wrong. */
bool tracer_provides(struct spirv code, struct shader_choice choice, char problem[128]);

/* Builds the pipeline and uploads the scene, which must outlive the tracer. On failure (reported) *tracer is
 * NULL. */
enum status tracer_create(struct vulkan_context *context, const struct packed_scene *scene,
                          const struct tracer_options *options, struct tracer **tracer);
void tracer_destroy(struct tracer **tracer);

/* Gives the tracer another scene, which must outlive it in the place of the old one, if the pipeline is also
 * right for that: if no number of things and no feature is different. Otherwise returns false and changes
 * nothing. */
bool tracer_update(struct tracer *tracer, const struct packed_scene *scene);

/* Renders the window of the picture into image, which has the window's size (and, if it has room for it,
 * the values in double precision). *dispatch_ms gets the time that
 * the device spent (device timestamps where it has them, otherwise from submission to completion). Advances
 * progress, whose unit is a pixel. STATUS_INTERRUPTED after Ctrl-C. */
enum status tracer_render(struct tracer *tracer, struct window window, struct image *image,
                          struct progress *progress, double *dispatch_ms);

/* The events of the pixel that was rendered last, in a window of its own, in the tracer's memory: EventHead
 * of scene_layout.h and EVENT_VALUES float or double each. The number of those that took place; of these
 * tracer_options.event_room at most are there. */
uint32_t tracer_events(const struct tracer *tracer, const void **events);

#endif
