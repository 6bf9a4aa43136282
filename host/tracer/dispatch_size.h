#ifndef VKWHITTED_TRACER_DISPATCH_SIZE_H
#define VKWHITTED_TRACER_DISPATCH_SIZE_H

#include "packed_scene.h"
#include "vulkan/context.h"

/* How invocations cover the picture, and how much one does in a dispatch. */
struct dispatch_size {
    bool on_processor;                  /* whose threads run invocations in the lanes of vectors */
    uint32_t group_width, group_height; /* invocations in a work group */
    uint32_t columns;                   /* pixels that an invocation renders, a group's width apart */
    uint32_t threads;                   /* that share a dispatch */
    uint32_t samples;                   /* at most, of each pixel */
    uint32_t light_points_a_turn;       /* of the loop over rays */
    bool primary_rays_first;            /* before the loop over rays */
    uint32_t most_turns;                /* of the loop over rays */
    uint32_t most_steps;                /* of searches in the hierarchy; 0: there is none */
    bool resumable;                     /* an invocation may take more turns than that */
    uint32_t saved_reals, saved_words;  /* slots that an invocation has in memory, see path.glsl */
    unsigned tile_pixels;               /* at most, in a tile */
    unsigned tile_invocations;          /* at most, for whose slots there is room */
};

enum { SAVED_REAL_BYTES = 4 * sizeof(float) }; /* twice as many in double precision */

/* A size that suits the device and the scene, with values of so many bytes. */
struct dispatch_size dispatch_size_choose(const struct vulkan_context *context,
                                          const struct packed_scene *scene, size_t value_size);

#endif
