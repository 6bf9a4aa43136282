#ifndef VKWHITTED_SCENE_HOLLOW_H
#define VKWHITTED_SCENE_HOLLOW_H

#include "base/status.h"
#include "packed_scene.h"

/* Sets HOLDS_RAYS and HOLDS_LIGHTS of all spheres; all else of the scene is final. STATUS_DONE or
 * STATUS_INTERRUPTED. */
enum status hollow_pack(struct packed_scene *packed);

#endif
