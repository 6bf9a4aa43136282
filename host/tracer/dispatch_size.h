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
    uint32_t light_points_a_turn;       /* of the loop over rays */
    bool primary_rays_first;            /* before the loop over rays */
    uint32_t most_turns;                /* of the loop over rays */
    uint32_t most_steps;                /* of searches in the hierarchy; 0: there is none */
    bool resumable;                     /* an invocation may take more turns than that */
    uint32_t saved_reals, saved_words;  /* slots that an invocation has in memory, see path.glsl */
    unsigned tile_pixels;               /* at most, in a tile */
    unsigned tile_groups;               /* at most, in a tile: those for whose slots there is room */
};

enum { SAVED_REAL_BYTES = 4 * sizeof(float) }; /* twice as many in double precision */

/* Groups that cover so many pixels. */
static inline uint32_t groups_across(const struct dispatch_size *size, uint32_t width)
{
    const uint32_t columns = size->group_width * size->columns;
    return (width + columns - 1) / columns;
}

/* Rows of groups beyond those that cover a tile, so that each thread gets as many, see dealt_threads(). */
static inline uint32_t most_excess(uint32_t rows_of_groups)
{
    return rows_of_groups / 64;
}

/* A size that suits the device and the scene, with values of so many bytes. */
struct dispatch_size dispatch_size_choose(const struct vulkan_context *context,
                                          const struct packed_scene *scene, size_t value_size);

#endif
