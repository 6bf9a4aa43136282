#ifndef VKWHITTED_SCENE_PACK_H
#define VKWHITTED_SCENE_PACK_H

#include "packed_scene.h"
#include "scene/scene.h"

/* The settings of one picture: the scene file's, unless the command line says otherwise. */
struct picture_settings {
    unsigned width, height; /* pixels */
    unsigned max_bounces, samples, light_samples;
    bool has_max_error;
    double max_error; /* linear radiance, of a pixel's channel: rays that stay below it together are not
                         traced */
};

/* Rounds the scene to the single-precision form that device and reference read, in scene units, and settles
 * once, for both, what is certain of it: which side of an opaque plane the camera is on, what can shadow,
 * what can hold a ray's origin or a light, which spheres are looped over. On STATUS_DONE the caller frees
 * *packed with pack_destroy(); otherwise it is empty: STATUS_REFUSED (reported) for a light too bright, a
 * sphere too small or a field of view too wide for float's exponents, STATUS_UNABLE without memory. Where the
 * other packed scene, or NULL, has the same spheres, its hierarchy is shared, not built again. */
enum status pack_scene(const struct packed_scene *other, const struct scene *scene,
                       const struct picture_settings *settings, struct packed_scene *packed);
void pack_destroy(struct packed_scene *packed);

/* Scene units in a metre, a power of two. */
double pack_scale(const struct scene *scene);

#endif
