#ifndef VKWHITTED_SCENE_DIGEST_H
#define VKWHITTED_SCENE_DIGEST_H

#include <stdint.h>

#include "packed_scene.h"

/* A number that differs where two packed scenes do, files of spheres included, but for one case in 2^64. A
 * picture in exact mode depends on nothing else but its precision. Not against forgers. */
uint64_t pack_digest(const struct packed_scene *packed);

#endif
