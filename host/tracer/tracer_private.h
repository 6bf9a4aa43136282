#ifndef VKWHITTED_TRACER_TRACER_PRIVATE_H
#define VKWHITTED_TRACER_TRACER_PRIVATE_H

/* Shared by tracer.c, which builds a tracer, tracer_render.c, which runs it, and the other tracer_*.c, which
 * hold a part of it each; for no other file. */

#include "tracer/specialization.h"
#include "tracer/tracer.h"
#include "vulkan/buffer.h"

enum {
    VIEW,
    SPHERES,
    PLANES,
    POINT_LIGHTS,
    QUAD_LIGHTS,
    SCENE_BINDINGS,
    PICTURE = SCENE_BINDINGS,
    SAVED_PIXELS,
    SAVED_STACKS,
    EVENTS,
    BINDINGS,
};

enum { CHANNELS = 3 };

struct tracer {
    struct vulkan_context *context;
    bool scene_in_storage, double_precision;
    bool resumable; /* ray trees may take several dispatches; see shaders/resume.glsl */
    const struct packed_scene *packed;
    struct tracer_options options;
    struct group_shape shape;
    unsigned tile_pixels, samples_per_dispatch;
    struct vulkan_buffer scene, picture;
    struct vulkan_buffer saved_pixels, saved_stacks; /* once resumable */
    struct vulkan_buffer events;                     /* only if asked for */
    struct vulkan_buffer staging;                    /* only where the host cannot read `picture` well */
    VkDescriptorBufferInfo bindings[BINDINGS];
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout pipeline_layout;
    VkPipeline pipeline;
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkQueryPool timestamps;
    VkFence fence;
    unsigned picture_width, picture_height;
};

/* As in whitted.comp. */
struct push_constants {
    uint32_t tile_x, tile_y, tile_width, tile_height, picture_width, picture_height, first_sample, end_sample;
    uint32_t goes_on; /* with what the dispatch before has left of the sample */
};

/* Bytes. */
static inline size_t pixel_size(const struct tracer *tracer)
{
    return CHANNELS * (tracer->double_precision ? sizeof(double) : sizeof(float));
}

/* Of the shader's binding. */
static inline bool is_storage_buffer(uint32_t binding, bool scene_in_storage)
{
    return binding >= PICTURE || (binding != VIEW && scene_in_storage);
}

/* Whether a part of the scene is too large for the device's uniform buffers. */
bool tracer_scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene);

/* Lays the scene's parts out in one buffer, tracer->scene. */
enum status tracer_upload_scene(struct tracer *tracer, const struct packed_scene *scene);

/* Copies a scene with as many parts into that buffer. */
void tracer_copy_scene(struct tracer *tracer, const struct packed_scene *scene);

/* Builds tracer->pipeline for the current shape; there is none yet. */
enum status tracer_build_pipeline(struct tracer *tracer);

/* From now on ray trees may take several dispatches: smaller tiles, another pipeline. */
enum status tracer_become_resumable(struct tracer *tracer);

/* Makes the buffer of the events, if there are to be any. */
enum status tracer_create_events(struct tracer *tracer);

#endif
