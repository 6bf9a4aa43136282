#ifndef VKWHITTED_TRACER_DISPATCH_H
#define VKWHITTED_TRACER_DISPATCH_H

#include "tracer/interface.h"
#include "tracer/specialization.h"
#include "vulkan/buffer.h"

/* The packed scene in the device's memory. */
struct scene_buffer {
    struct vulkan_buffer buffer;
    VkDescriptorBufferInfo parts[SCENE_BINDINGS]; /* of the buffer; some may not be there */
    VkBufferView texels[SCENE_BINDINGS];          /* of those that are texel buffers */
};

/* Whether a part of the scene is too large for the device's uniform buffers, or has a hierarchy. */
bool scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene);

/* Lays the scene's parts out in one buffer, to be bound as uniform or as storage buffers. On failure
 * (reported) it is empty. */
enum status scene_buffer_create(struct vulkan_context *context, const struct packed_scene *scene,
                                bool storage, struct scene_buffer *scene_buffer);
void scene_buffer_destroy(struct vulkan_context *context, struct scene_buffer *scene_buffer);

/* Copies a scene with as many objects and lights over the one in the buffer. Where it has another number of
 * surfaces it returns false and changes nothing. */
bool scene_buffer_update(struct scene_buffer *scene_buffer, const struct packed_scene *old,
                         const struct packed_scene *scene);

enum { CHANNELS = 4 };

/* What the shader's four values of a pixel are: RGB and charges, as real numbers; or, for the outputs that
 * are counted, integers: secondary rays, shadow rays, path signature. */
enum value_type { VALUE_FLOAT, VALUE_DOUBLE, VALUE_UINT32 };

/* What a dispatch does of a tile. As TileBlock in whitted.comp. */
struct portion {
    uint32_t tile_x, tile_y, tile_width, tile_height, picture_width, picture_height; /* pixels */
    uint32_t goes_on; /* with what the dispatch before has left */
    uint32_t most_turns, threads;
};

/* A tile on its way. */
struct dispatch_frame {
    struct vulkan_buffer buffers[BINDINGS]; /* from PICTURE on, those that the pipeline uses */
    struct vulkan_buffer staging;           /* only where the host cannot read the picture well */
    struct pass_frame frame;
    const void *values; /* of the tile, row by row, CHANNELS a pixel */
    struct portion portion;
    bool under_way; /* on the device */
};

/* Renders tiles of a picture with one pipeline. */
struct dispatcher {
    struct vulkan_context *context;
    const struct packed_scene *scene;
    struct tracer_options options;
    struct shader_choice choice;
    struct scene_buffer scene_buffer;
    struct dispatch_size size;
    enum value_type value_type;
    struct vulkan_pass pass;
};

/* What the buffer of EVENTS begins with. As EventBlock in shaders/events.glsl. */
struct event_block {
    uint32_t count, room, unused[2];
};

/* Uploads the scene and builds the pipeline; context, scene, options and choice are set. Failures are
 * reported. */
enum status dispatcher_create(struct dispatcher *dispatcher);

/* Destroys what there is of it. */
void dispatcher_destroy(struct dispatcher *dispatcher);

/* What the scene would need of the dispatcher's pipeline. */
struct specialization dispatcher_specialization(const struct dispatcher *dispatcher,
                                                const struct packed_scene *scene);

/* Makes the buffers for tiles of up to so many pixels. On failure (reported) *frame is empty. */
enum status dispatch_frame_create(const struct dispatcher *dispatcher, uint32_t tile_width,
                                  uint32_t tile_height, struct dispatch_frame *frame);

/* Destroys a frame that is not under way, or nothing. */
void dispatch_frame_destroy(const struct dispatcher *dispatcher, struct dispatch_frame *frame);

/* Starts the frame's portion, but for its number of threads, which it sets. Failures are reported. */
enum status dispatch_frame_start(const struct dispatcher *dispatcher, struct dispatch_frame *frame);

/* Waits for it, and adds the device's time to *device_ms. *unfinished: the pixels that are not in the values
 * yet, so that the next dispatch has to go on with them. */
enum status dispatch_frame_wait(const struct dispatcher *dispatcher, struct dispatch_frame *frame,
                                double *device_ms, uint32_t *unfinished);

/* Brings the values where the host reads them well, if the dispatch has not. */
enum status dispatch_frame_fetch(const struct dispatcher *dispatcher, struct dispatch_frame *frame);

#endif
