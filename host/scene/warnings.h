#ifndef VKWHITTED_SCENE_WARNINGS_H
#define VKWHITTED_SCENE_WARNINGS_H

#include "scene/scene.h"

/* Warns of what a scene may hold and is likely a mistake: transparent bodies whose surfaces cross (the first
 * pair, and how many more there are), and the first quad light that shines away from all matte surfaces. */
void scene_warn(const struct scene *scene);

#endif
