#ifndef VKWHITTED_SCENE_OVERLAP_H
#define VKWHITTED_SCENE_OVERLAP_H

#include "scene/scene.h"

/* Warns of transparent bodies whose surfaces cross: of the pair that is complete first in the file, of its
 * partners the first, and of how many pairs more there are. Without memory for that it says that there may be
 * some. */
void overlaps_warn(const struct scene *scene);

#endif
