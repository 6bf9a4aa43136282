#include "tracer/dispatch.h"

#include <string.h>

/* A part of the scene as it lies in memory; without data: LoopedSphere. */
struct scene_part {
    const void *data;
    size_t size;
};

static struct scene_part part_of(const struct packed_scene *scene, int i)
{
    const struct scene_part parts[SCENE_BINDINGS] = {
        [VIEW] = {&scene->view, sizeof scene->view},
        [SPHERES] = {NULL, sizeof(struct LoopedSphere) * (size_t)scene->looped_spheres},
        [PLANES] = {scene->planes, sizeof *scene->planes * (size_t)scene->plane_count},
        [POINT_LIGHTS] = {scene->point_lights,
                          sizeof *scene->point_lights * (size_t)scene->point_light_count},
        [QUAD_LIGHTS] = {scene->quad_lights, sizeof *scene->quad_lights * (size_t)scene->quad_light_count},
    };
    return parts[i];
}

/* The part's bytes, and room for at least one element more, which the shader's arrays have even where there
 * is none. The next part may begin there: it is the largest offset alignment that Vulkan allows a device. */
static VkDeviceSize part_range(const struct packed_scene *scene, int i)
{
    enum { ALIGNMENT = 256 };
    _Static_assert(sizeof(struct PackedQuadLight) <= ALIGNMENT / 2, "");
    return (part_of(scene, i).size / ALIGNMENT + 1) * ALIGNMENT;
}

bool scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene)
{
    bool needed = false;
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        needed |= part_range(scene, i) > context->properties.limits.maxUniformBufferRange;
    return needed;
}

void scene_buffer_update(struct scene_buffer *scene_buffer, const struct packed_scene *scene)
{
    for (int i = 0; i < SCENE_BINDINGS; ++i) {
        struct scene_part part = part_of(scene, i);
        void *to = (unsigned char *)scene_buffer->buffer.mapped + scene_buffer->parts[i].offset;
        if (part.data)
            memcpy(to, part.data, part.size);
        for (int k = 0; !part.data && k < scene->looped_spheres; ++k)
            ((struct LoopedSphere *)to)[k] = (struct LoopedSphere){scene->spheres[k], scene->surfaces[k]};
    }
}

enum status scene_buffer_create(struct vulkan_context *context, const struct packed_scene *scene,
                                struct scene_buffer *scene_buffer)
{
    VkDeviceSize size = 0;
    for (int i = 0; i < SCENE_BINDINGS; ++i) {
        scene_buffer->parts[i] = (VkDescriptorBufferInfo){.offset = size, .range = part_range(scene, i)};
        size += scene_buffer->parts[i].range;
    }
    enum status status = vulkan_buffer_create(context, "scene", size, BUFFER_UPLOAD, &scene_buffer->buffer);
    if (status != STATUS_DONE)
        return status;
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        scene_buffer->parts[i].buffer = scene_buffer->buffer.buffer;
    scene_buffer_update(scene_buffer, scene);
    return STATUS_DONE;
}
