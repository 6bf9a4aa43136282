#ifndef VKWHITTED_SCENE_BYTES_H
#define VKWHITTED_SCENE_BYTES_H

#include "packed_scene.h"

/* Packed scenes in a file, which x86-64 and aarch64 read alike: for each this, then its spheres, planes,
 * point lights and quad lights. The pointers in `scene` mean nothing. */
struct scene_bytes {
    char name[64];
    struct packed_scene scene;
};

#endif
