#ifndef VKWHITTED_SCENE_WARNINGS_H
#define VKWHITTED_SCENE_WARNINGS_H

#include "scene/scene.h"

/* Warns of what a scene may hold and is likely a mistake: transparent bodies whose surfaces cross, and quad
 * lights that shine away from all matte surfaces. Each kind is one message, however often it occurs. */
void scene_warn(const struct scene *scene);

#endif
