#ifndef VKWHITTED_TRACER_DISPATCH_H
#define VKWHITTED_TRACER_DISPATCH_H

#include "tracer/interface.h"
#include "tracer/specialization.h"
#include "vulkan/buffer.h"

/* The packed scene in the device's memory. */
struct scene_buffer {
    struct vulkan_buffer buffer;
    VkDescriptorBufferInfo parts[SCENE_BINDINGS]; /* of the buffer */
};

/* Whether a part of the scene is too large for the device's uniform buffers. */
bool scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene);

/* Lays the scene's parts out in one buffer. On failure (reported) it is empty; to be destroyed by
 * vulkan_buffer_destroy(). */
enum status scene_buffer_create(struct vulkan_context *context, const struct packed_scene *scene,
                                struct scene_buffer *scene_buffer);

/* Copies a scene with as many objects and lights over the one in the buffer. */
void scene_buffer_update(struct scene_buffer *scene_buffer, const struct packed_scene *scene);

enum { CHANNELS = 3 };

/* What the shader's three values of a pixel are: real numbers or, for the outputs that are counted, integers.
 */
enum value_type { VALUE_FLOAT, VALUE_DOUBLE, VALUE_UINT32 };

/* What all dispatchers of a tracer have in common. */
struct dispatcher_info {
    struct vulkan_context *context;
    const struct packed_scene *scene;
    struct tracer_options options;
    struct shader_choice choice;
    struct scene_buffer scene_buffer;
};

/* Renders tiles of a picture with one pipeline, one at a time. */
struct dispatcher {
    struct vulkan_context *context;
    struct dispatch_size size;
    enum value_type value_type;
    const void *values;                     /* of the last tile, row by row, CHANNELS a pixel */
    struct vulkan_buffer buffers[BINDINGS]; /* from PICTURE on, those that the pipeline uses */
    struct vulkan_buffer staging;           /* only where the host cannot read the picture well */
    struct vulkan_pass pass;
};

/* A dispatch: samples of a tile. As TileBlock in whitted.comp. */
struct portion {
    uint32_t tile_x, tile_y, tile_width, tile_height, picture_width, picture_height; /* pixels */
    uint32_t first_sample, end_sample;
    uint32_t goes_on; /* with what the dispatch before has left of the sample */
};

/* What the buffer of EVENTS begins with. As EventBlock in shaders/events.glsl. */
struct event_block {
    uint32_t count, room, unused[2];
};

/* Builds the pipeline and what it needs; the scene's buffer must outlive the dispatcher. On failure
 * (reported) *dispatcher is empty. */
enum status dispatcher_create(const struct dispatcher_info *info, struct dispatch_size size,
                              struct dispatcher *dispatcher);

/* Destroys it, or nothing. */
void dispatcher_destroy(struct dispatcher *dispatcher);

/* Adds the portion to the tile's values, and the device's time to *dispatch_ms. Failures are reported. */
enum status dispatcher_run(struct dispatcher *dispatcher, const struct portion *portion, double *dispatch_ms);

/* The lowest of the first values of so many pixels: UNFINISHED or TOO_LONG of scene_layout.h, or something
 * lower where ended loops have left a pixel as it was in memory; 0 if all are done. */
double dispatcher_mark(const struct dispatcher *dispatcher, size_t pixels);

#endif
