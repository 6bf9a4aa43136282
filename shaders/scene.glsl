// The scene's data and the constants that specialise the pipeline to it. Whatever a constant says does not
// occur is compiled away.
#include "scene_layout.h"

layout(constant_id = 2) const int SPHERES = 0;
layout(constant_id = 3) const int PLANES = 0;
layout(constant_id = 4) const int POINT_LIGHTS = 0;
layout(constant_id = 5) const int QUAD_LIGHTS = 0;
layout(constant_id = 6) const int MAX_BOUNCES = 5;
layout(constant_id = 7) const int SAMPLES = 1;
layout(constant_id = 8) const int LIGHT_SAMPLES = 1;
layout(constant_id = 9) const bool MIRRORS = true;
layout(constant_id = 10) const bool GLASS = true;
layout(constant_id = 11) const bool GLASS_PLANES = true;
layout(constant_id = 12) const bool ROUGH = true;            // some matte is not Lambert
layout(constant_id = 13) const bool SPHERES_HOLD_RAYS = true;   // some sphere has PackedSphere tag z
layout(constant_id = 14) const bool SPHERES_HOLD_LIGHTS = true; // some sphere has PackedSphere tag w
layout(constant_id = 15) const bool PLANES_SHADOW = true;       // some plane has PackedPlane tag z
layout(constant_id = 16) const bool MIXED_ORDER = true; // a plane stands before a sphere in the file
layout(constant_id = 17) const bool COUNT_RAYS = false; // pixels are primary, secondary, shadow ray counts

const bool SECONDARY_RAYS = (MIRRORS || GLASS) && MAX_BOUNCES > 0;

#ifdef SCENE_IN_STORAGE
#define SCENE_ARRAY(slot, Type, name, count) \
    layout(std430, set = 0, binding = slot) readonly buffer Type##Block { Type name[]; }
#else
#define SCENE_ARRAY(slot, Type, name, count) \
    layout(std140, set = 0, binding = slot) uniform Type##Block { Type name[count + 1]; }
#endif

layout(std140, set = 0, binding = 0) uniform ViewBlock { PackedView view; };
SCENE_ARRAY(1, PackedSphere, spheres, SPHERES);
SCENE_ARRAY(2, PackedPlane, planes, PLANES);
SCENE_ARRAY(3, PackedPointLight, point_lights, POINT_LIGHTS);
SCENE_ARRAY(4, PackedQuadLight, quad_lights, QUAD_LIGHTS);
