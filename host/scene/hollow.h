#ifndef VKWHITTED_SCENE_HOLLOW_H
#define VKWHITTED_SCENE_HOLLOW_H

#include "packed_scene.h"

/* Sets HOLDS_RAYS and HOLDS_LIGHTS of all spheres; all else of the scene is final. other: a packed scene that
 * may have the same hierarchy, or NULL. */
void hollow_pack(const struct packed_scene *other, struct packed_scene *packed);

#endif
