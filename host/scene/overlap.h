#ifndef VKWHITTED_SCENE_OVERLAP_H
#define VKWHITTED_SCENE_OVERLAP_H

#include "scene/body.h"

enum { OVERLAP_MOST_PAIRS = 1000 }; /* that are counted: a dense cloud of n spheres has n^2 / 2 */

struct overlaps {
    size_t pairs; /* OVERLAP_MOST_PAIRS: so many or more */
    struct body_place earlier,
        later; /* the pair that is complete first in the file; of its partners the first */
};

/* Finds transparent bodies whose surfaces cross. STATUS_UNABLE (reported) without memory. */
enum status overlaps_find(const struct scene *scene, struct overlaps *overlaps);

#endif
