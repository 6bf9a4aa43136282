#ifndef VKWHITTED_TRACER_SPECIALIZATION_H
#define VKWHITTED_TRACER_SPECIALIZATION_H

#include <stdbool.h>
#include <vulkan/vulkan.h>

#include "packed_scene.h"

/* How the shader's invocations cover the picture. */
struct group_shape {
    uint32_t width, height; /* invocations in a work group */
    uint32_t rows;          /* pixels that an invocation renders, one below the other */
};

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

/* Finds what the scene needs, so that the pipeline holds nothing else. */
struct specialization specialize(const struct packed_scene *scene, const struct group_shape *shape,
                                 int output);

#endif
