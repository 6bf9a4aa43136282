#ifndef VKWHITTED_SCENE_LOOPED_H
#define VKWHITTED_SCENE_LOOPED_H

#include <stdbool.h>

#include "scene/scene.h"

enum {
    MOST_LOOPED = 24, /* spheres that are tried one after the other as fast as others are found */
    MOST_LARGE = 16
};

/* Which of a scene's spheres are looped over: all, if they are few; of
 * many only the largest, which would fill the boxes and the grid of what finds the others: spheres with a
 * diameter of more than half the longest side of the box around all that are not so large. */
struct looped {
    size_t sphere_count; /* of the scene */
    size_t large_count;
    size_t large[MOST_LARGE]; /* numbers of bodies, the largest first */
};

struct looped looped_choose(const struct scene *scene);

static inline bool is_large(const struct looped *looped, size_t sphere)
{
    bool is = false;
    for (size_t i = 0; i < looped->large_count; ++i)
        is |= looped->large[i] == sphere;
    return is;
}

static inline bool is_looped(const struct looped *looped, size_t sphere)
{
    return looped->sphere_count <= MOST_LOOPED || is_large(looped, sphere);
}

#endif
