#ifndef VKWHITTED_SCENE_WARNINGS_H
#define VKWHITTED_SCENE_WARNINGS_H

#include "packed_scene.h"
#include "scene/scene.h"

/* Warns of what a scene, and packed what pack_scene() made of it, may hold and is likely a mistake:
 * transparent bodies whose surfaces cross (the first pair, and how many more there are), and the first quad
 * light that shines away from all matte surfaces. */
void scene_warn(const struct scene *scene, const struct packed_scene *packed);

#endif
