#ifndef VKWHITTED_TRACER_SPECIALIZATION_H
#define VKWHITTED_TRACER_SPECIALIZATION_H

#include "tracer/dispatch_size.h"
#include "tracer/interface.h"

/* The values of the shader's constants 0, 1, 2...; shaders/scene.glsl and arithmetic.glsl say what they
 * mean. */
struct specialization {
    uint32_t group_width, group_height;
    int32_t spheres, planes, point_lights, quad_lights, max_bounces, samples, light_samples;
    VkBool32 mirrors, glass, glass_planes, rough, spheres_hold_rays, spheres_hold_lights, planes_shadow,
        mixed_order, one_roughness;
    uint32_t plane_axes, columns;
    VkBool32 counts, prunes, charges, resumable, rays_escape, processor;
    uint32_t light_points_a_turn;
    uint32_t giants;
    VkBool32 hoisted, primary_rays_first;
    int32_t all_spheres;
    uint32_t most_steps;
    VkBool32 corrected_division;
};

/* Finds what the scene and the options need, so that the pipeline holds nothing else. */
struct specialization specialize(const struct packed_scene *scene, const struct dispatch_size *size,
                                 const struct tracer_options *options);

/* Whether the shader's constants that are RARE have the values that its plain variant fixes. */
bool is_plain(const struct specialization *constants);

#endif
