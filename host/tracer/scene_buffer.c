#include "tracer/dispatch.h"

#include <string.h>

#include "tracer/sphere_records.h"

/* A part of the scene as it lies in memory; without data it is made there. */
struct scene_part {
    const void *data;
    uint64_t size;
    VkFormat format; /* of texels */
};

static struct scene_part part_of(const struct packed_scene *scene, int i)
{
    const struct scene_part parts[SCENE_BINDINGS] = {
        [VIEW] = {&scene->view, sizeof scene->view, 0},
        [SPHERES] = {NULL, sizeof(struct LoopedSphere) * (size_t)scene->looped_spheres, 0},
        [PLANES] = {scene->planes, sizeof *scene->planes * (size_t)scene->plane_count, 0},
        [POINT_LIGHTS] = {scene->point_lights, sizeof *scene->point_lights * (size_t)scene->point_light_count,
                          0},
        [QUAD_LIGHTS] = {scene->quad_lights, sizeof *scene->quad_lights * (size_t)scene->quad_light_count, 0},
        [RECORDS] = {NULL, 4 * sizeof(uint32_t) * sphere_record_count(scene), VK_FORMAT_R32G32B32A32_UINT},
        [RECORD_WORDS] = {NULL, sizeof(uint32_t) * sphere_word_count(scene), VK_FORMAT_R32_UINT},
        [SURFACES] = {scene->surfaces, sizeof *scene->surfaces * (size_t)scene->surface_count, 0},
    };
    return parts[i];
}

/* The part's bytes, and room for at least one element more, which the shader's arrays have even where there
 * is none. The next part may begin there: it is the largest offset alignment that Vulkan allows a device. */
static VkDeviceSize part_range(struct scene_part part)
{
    enum { ALIGNMENT = 256 };
    _Static_assert(sizeof(struct PackedQuadLight) <= ALIGNMENT / 2, "");
    return (part.size / ALIGNMENT + 1) * ALIGNMENT;
}

bool scene_needs_storage(const struct vulkan_context *context, const struct packed_scene *scene)
{
    bool needed = scene->hierarchy;
    for (int i = 0; i < RECORDS; ++i)
        needed |= part_range(part_of(scene, i)) > context->properties.limits.maxUniformBufferRange;
    return needed;
}

static void copy_part(const struct scene_buffer *scene_buffer, const struct packed_scene *scene, int i)
{
    const struct scene_part part = part_of(scene, i);
    void *to = (unsigned char *)scene_buffer->buffer.mapped + scene_buffer->parts[i].offset;
    if (part.data)
        memcpy(to, part.data, part.size);
    for (int k = 0; i == SPHERES && k < scene->looped_spheres; ++k)
        ((struct LoopedSphere *)to)[k] = (struct LoopedSphere){scene->spheres[k], scene->surfaces[k]};
}

static void copy_parts(const struct scene_buffer *scene_buffer, const struct packed_scene *scene)
{
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        if (scene_buffer->parts[i].buffer)
            copy_part(scene_buffer, scene, i);
}

static void write_records(const struct scene_buffer *scene_buffer, const struct packed_scene *scene)
{
    unsigned char *mapped = scene_buffer->buffer.mapped;
    sphere_records_write(scene, (uint32_t(*)[4])(void *)(mapped + scene_buffer->parts[RECORDS].offset),
                         (uint32_t *)(void *)(mapped + scene_buffer->parts[RECORD_WORDS].offset));
}

bool scene_buffer_update(struct scene_buffer *scene_buffer, const struct packed_scene *old,
                         const struct packed_scene *scene)
{
    if (old->surface_count != scene->surface_count)
        return false;
    copy_parts(scene_buffer, scene);
    const size_t size = (size_t)scene->sphere_count * sizeof *scene->spheres;
    if (scene->hierarchy && memcmp(old->spheres, scene->spheres, size) != 0)
        write_records(scene_buffer, scene);
    return true;
}

static enum status create_texels(struct vulkan_context *context, VkFormat format, uint64_t count, int i,
                                 struct scene_buffer *scene_buffer)
{
    const VkPhysicalDeviceLimits *limits = &context->properties.limits;
    if (count <= limits->maxTexelBufferElements)
        return vulkan_texels_create(context, scene_buffer->parts[i], format, &scene_buffer->texels[i]);
    log_error("the spheres need a buffer of %llu texels; %s has them with up to %u",
              (unsigned long long)count, context->properties.deviceName, limits->maxTexelBufferElements);
    return STATUS_UNABLE;
}

enum status scene_buffer_create(struct vulkan_context *context, const struct packed_scene *scene,
                                bool storage, struct scene_buffer *scene_buffer)
{
    const int parts = storage ? SCENE_BINDINGS : RECORDS;
    VkDeviceSize size = 0;
    *scene_buffer = (struct scene_buffer){0};
    for (int i = 0; i < parts; ++i) {
        const VkDeviceSize range = part_range(part_of(scene, i));
        scene_buffer->parts[i] = (VkDescriptorBufferInfo){.offset = size, .range = range};
        size += range;
    }
    enum status status = vulkan_buffer_create(context, "scene", size, BUFFER_UPLOAD, &scene_buffer->buffer);
    for (int i = 0; i < parts && status == STATUS_DONE; ++i) {
        const struct scene_part part = part_of(scene, i);
        scene_buffer->parts[i].buffer = scene_buffer->buffer.buffer;
        if (part.format)
            status = create_texels(
                context, part.format,
                scene_buffer->parts[i].range / (part.format == VK_FORMAT_R32_UINT ? 4 : 16), i, scene_buffer);
    }
    if (status != STATUS_DONE) {
        scene_buffer_destroy(context, scene_buffer);
        return status;
    }
    copy_parts(scene_buffer, scene);
    if (storage)
        write_records(scene_buffer, scene);
    return STATUS_DONE;
}

void scene_buffer_destroy(struct vulkan_context *context, struct scene_buffer *scene_buffer)
{
    for (int i = 0; i < SCENE_BINDINGS; ++i)
        vulkan_texels_destroy(context, &scene_buffer->texels[i]);
    vulkan_buffer_destroy(context, &scene_buffer->buffer);
    *scene_buffer = (struct scene_buffer){0};
}
