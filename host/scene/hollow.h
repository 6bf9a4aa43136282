#ifndef VKWHITTED_SCENE_HOLLOW_H
#define VKWHITTED_SCENE_HOLLOW_H

#include "packed_scene.h"

/* Sets HOLDS_RAYS and HOLDS_LIGHTS of all spheres; all else of the scene is final. */
void hollow_pack(struct packed_scene *packed);

#endif
