#ifndef VKWHITTED_TRACER_SPECIALIZATION_H
#define VKWHITTED_TRACER_SPECIALIZATION_H

#include "packed_scene.h"
#include "vulkan/context.h"

/* How much a dispatch does, and how its invocations cover the picture. */
struct dispatch_size {
    uint32_t group_width, group_height; /* invocations in a work group */
    uint32_t rows;                      /* pixels that an invocation renders, one below the other */
    unsigned tile_pixels;               /* at most, in a tile */
    unsigned samples;                   /* at most, of each pixel */
    unsigned stack_room; /* entries of a pixel's stack saved for the next dispatch; 0: none is saved */
};

/* Of SavedPixel and SavedPath in resume.glsl, in double; float takes less. */
enum { SAVED_PIXEL_BYTES = 192, SAVED_PATH_BYTES = 64 };

/* A size that suits the device and the scene. */
struct dispatch_size dispatch_size_choose(const struct vulkan_context *context,
                                          const struct packed_scene *scene);

/* The smaller one for ray trees that take several dispatches, see shaders/resume.glsl. */
struct dispatch_size dispatch_size_resumable(struct dispatch_size size, const struct packed_scene *scene);

/* The values of the shader's constants 0, 1, 2...; shaders/scene.glsl says what they mean. */
struct specialization {
    uint32_t group_width, group_height;
    int32_t spheres, planes, point_lights, quad_lights, max_bounces, samples, light_samples;
    VkBool32 mirrors, glass, glass_planes, rough, spheres_hold_rays, spheres_hold_lights, planes_shadow,
        mixed_order, one_roughness;
    uint32_t plane_axes, rows, entered_spheres;
    int32_t output;                              /* OUTPUT_ */
    VkBool32 corrected_division, corrected_root; /* see probe.h */
    VkBool32 prunes;
    uint32_t turn_limit;
    VkBool32 resumable, rays_escape;
};

/* Finds what the scene and the device, whose arithmetic is known, need, so that the pipeline holds nothing
 * else. */
struct specialization specialize(const struct vulkan_context *context, const struct packed_scene *scene,
                                 const struct dispatch_size *size, int output);

#endif
