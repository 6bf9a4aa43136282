#ifndef VKWHITTED_TRACER_DISPATCH_SIZE_H
#define VKWHITTED_TRACER_DISPATCH_SIZE_H

#include "tracer/specialization.h"
#include "vulkan/context.h"

/* How much a dispatch does. */
struct dispatch_size {
    struct group_shape shape;
    unsigned tile_pixels; /* at most, in a tile */
    unsigned samples;     /* at most, of each pixel */
    unsigned
        stack_room; /* entries of a pixel's stack that are saved for the next dispatch; 0: none is saved */
};

/* Of SavedPixel and SavedPath in resume.glsl, in double; float takes less. */
enum { SAVED_PIXEL_BYTES = 192, SAVED_PATH_BYTES = 64 };

/* A size that suits the device and the scene. */
struct dispatch_size dispatch_size_choose(const struct vulkan_context *context,
                                          const struct packed_scene *scene);

/* The smaller one for ray trees that take several dispatches, see shaders/resume.glsl. */
struct dispatch_size dispatch_size_resumable(struct dispatch_size size, const struct packed_scene *scene);

#endif
