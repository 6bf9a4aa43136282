#ifndef VKWHITTED_PACKED_SCENE_H
#define VKWHITTED_PACKED_SCENE_H

#include <stdbool.h>

#include "scene_layout.h"

/* Everything a renderer needs to know, for the device and the reference alike; C only. Both start from
 * these single-precision values, so that all precisions render exactly the same scene. */
struct packed_scene {
    struct PackedView view;
    int width, height; /* of the whole picture, pixels */
    int max_bounces, samples, light_samples;
    int sphere_count, plane_count, point_light_count, quad_light_count;
    int looped_spheres; /* the first so many, each with the surface of its number, are tried one after the
                         * other; the others are so many that the renderer needs a structure to find those on
                         * a ray's way */
    int surface_count;
    unsigned giants; /* a bit for each of the first 32 spheres: it is stored and met as a giant */
    struct PackedSphere *spheres;
    struct PackedSurface
        *surfaces; /* of spheres: one for each that is looped over, then those that others share */
    struct hierarchy *hierarchy; /* of the spheres that are not looped over; NULL: there are none */
    struct PackedPlane *planes;
    struct PackedPointLight *point_lights;
    struct PackedQuadLight *quad_lights;
    const struct sphere_tree
        *tree; /* the reference's, of the spheres that are not looped over; NULL: it tries all of them */
};

static inline bool is_giant(const struct packed_scene *scene, int surface)
{
    return surface < 32 && (scene->giants >> surface & 1) != 0;
}

#endif
