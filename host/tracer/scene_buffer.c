#include <string.h>

#include "tracer/tracer_private.h"

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

bool tracer_scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene)
{
    struct scene_part parts[SCENE_BINDINGS];
    bool needed = false;
    list_parts(scene, parts);
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        needed |= part_range(parts, i) > context->properties.limits.maxUniformBufferRange;
    return needed;
}

void tracer_copy_scene(struct tracer *tracer, const struct packed_scene *scene)
{
    struct scene_part parts[SCENE_BINDINGS];
    list_parts(scene, parts);
    for (int i = 0; i < SCENE_BINDINGS; ++i) {
        unsigned char *place = (unsigned char *)tracer->scene.mapped + tracer->bindings[i].offset;
        if (parts[i].count > 0)
            memcpy(place, parts[i].data, parts[i].element_size * parts[i].count);
    }
}

enum status tracer_upload_scene(struct tracer *tracer, const struct packed_scene *scene)
{
    static const VkDeviceSize alignment = 256; /* the largest offset alignment that Vulkan allows a device */
    struct scene_part parts[SCENE_BINDINGS];
    VkDeviceSize size = 0;
    list_parts(scene, parts);
    for (int i = 0; i < SCENE_BINDINGS; ++i) {
        VkDeviceSize range = part_range(parts, i);
        tracer->bindings[i] = (VkDescriptorBufferInfo){.offset = size, .range = range};
        size += (range + alignment - 1) / alignment * alignment;
    }
    enum status status = vulkan_buffer_create(
        tracer->context, size, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        (VkMemoryPropertyFlags[]){VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                      VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                  VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                  0},
        &tracer->scene);
    if (status != STATUS_DONE)
        return status;
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        tracer->bindings[i].buffer = tracer->scene.buffer;
    tracer_copy_scene(tracer, scene);
    return STATUS_DONE;
}
