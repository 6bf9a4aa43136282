#ifndef VKWHITTED_TRACER_SCENE_BUFFER_H
#define VKWHITTED_TRACER_SCENE_BUFFER_H

#include "packed_scene.h"
#include "tracer/interface.h"
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

#endif
