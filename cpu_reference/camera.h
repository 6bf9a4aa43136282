/* Rays from the camera. */
#ifndef REFERENCE_CAMERA_H
#define REFERENCE_CAMERA_H

#include "geometry.h"
#include "sobol.h"

/* What the light samples and pixel samples of a pixel are drawn by. */
static inline uint32_t pixel_seed(int x, int y)
{
    return hash32(hash32((uint32_t)x) + (uint32_t)y);
}

/* The ray of sample number k of the pixel: a single one goes through the middle. */
static inline struct ray camera_ray(const struct packed_scene *scene, int x, int y, uint32_t k)
{
    const struct PackedView *view = &scene->view;
    real sample_x = (real)0.5, sample_y = (real)0.5;
    const uint32_t seed = pixel_seed(x, y);
    if (scene->samples > 1)
        sobol_point(seed, sobol_shuffle(seed, k), &sample_x, &sample_y);
    real right = (real)(2 * x - scene->width) + 2 * sample_x;
    real down = (real)(2 * y - scene->height) + 2 * sample_y;
    struct vec3 through = add(add(vector_of(view->forward), scale(right, vector_of(view->half_pixel_right))),
                              scale(down, vector_of(view->half_pixel_down)));
    return (struct ray){
        .origin = vector_of(view->position),
        .direction = normalize(through),
        .surface = NO_SURFACE,
    };
}

#endif
