#include "tracer/scene_buffer.h"

#include <string.h>

/* A part of the scene as it lies in memory; the buffer has room for at least one element. */
struct scene_part {
    const void *data;
    size_t element_size, count;
};

static void list_parts(const struct packed_scene *scene, struct scene_part parts[SCENE_BINDINGS])
{
    parts[VIEW] = (struct scene_part){&scene->view, sizeof scene->view, 1};
    parts[SPHERES] = (struct scene_part){scene->spheres, sizeof *scene->spheres, (size_t)scene->sphere_count};
    parts[PLANES] = (struct scene_part){scene->planes, sizeof *scene->planes, (size_t)scene->plane_count};
    parts[POINT_LIGHTS] = (struct scene_part){scene->point_lights, sizeof *scene->point_lights,
                                              (size_t)scene->point_light_count};
    parts[QUAD_LIGHTS] =
        (struct scene_part){scene->quad_lights, sizeof *scene->quad_lights, (size_t)scene->quad_light_count};
}

static VkDeviceSize part_range(const struct scene_part parts[SCENE_BINDINGS], int i)
{
    return parts[i].element_size * (parts[i].count + (i == VIEW ? 0 : 1));
}

bool scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene)
{
    struct scene_part parts[SCENE_BINDINGS];
    bool needed = false;
    list_parts(scene, parts);
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        needed |= part_range(parts, i) > context->properties.limits.maxUniformBufferRange;
    return needed;
}

void scene_buffer_update(struct scene_buffer *scene_buffer, const struct packed_scene *scene)
{
    struct scene_part parts[SCENE_BINDINGS];
    list_parts(scene, parts);
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        if (parts[i].count > 0)
            memcpy((unsigned char *)scene_buffer->buffer.mapped + scene_buffer->parts[i].offset,
                   parts[i].data, parts[i].element_size * parts[i].count);
}

enum status scene_buffer_create(struct vulkan_context *context, const struct packed_scene *scene,
                                struct scene_buffer *scene_buffer)
{
    static const VkDeviceSize alignment = 256; /* the largest offset alignment that Vulkan allows a device */
    struct scene_part parts[SCENE_BINDINGS];
    VkDeviceSize size = 0;
    list_parts(scene, parts);
    for (int i = 0; i < SCENE_BINDINGS; ++i) {
        scene_buffer->parts[i] = (VkDescriptorBufferInfo){.offset = size, .range = part_range(parts, i)};
        size += (scene_buffer->parts[i].range + alignment - 1) / alignment * alignment;
    }
    enum status status = vulkan_buffer_create(
        context, "scene", size, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        BUFFER_UPLOAD, &scene_buffer->buffer);
    if (status != STATUS_DONE)
        return status;
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        scene_buffer->parts[i].buffer = scene_buffer->buffer.buffer;
    scene_buffer_update(scene_buffer, scene);
    return STATUS_DONE;
}
