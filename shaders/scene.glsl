// The scene's data and the constants that specialise the pipeline to it. Whatever a constant says does not
// occur is compiled away.
#include "scene_layout.h"

// What most scenes on a processor need no other value of. The plain variant has it fixed, for drivers take twice as long
// to compile all of it away (Mesa 22.3: 200 ms of figure 4's 300).
#ifdef PLAIN
#define RARE(id)
#else
#define RARE(id) layout(constant_id = id)
#endif

layout(constant_id = 2) const int SPHERES = 0; // that are looped over
layout(constant_id = 3) const int PLANES = 0;
layout(constant_id = 4) const int POINT_LIGHTS = 0;
RARE(5) const int QUAD_LIGHTS = 0;
layout(constant_id = 6) const int MAX_BOUNCES = 5;
layout(constant_id = 7) const int SAMPLES = 1;
layout(constant_id = 8) const int LIGHT_SAMPLES = 1;
layout(constant_id = 9) const bool MIRRORS = true;
layout(constant_id = 10) const bool GLASS = true;
layout(constant_id = 11) const bool GLASS_PLANES = true;
layout(constant_id = 12) const bool ROUGH = true;            // some matte is not Lambert
layout(constant_id = 13) const bool SPHERES_HOLD_RAYS = true;   // some sphere has HOLDS_RAYS
layout(constant_id = 14) const bool SPHERES_HOLD_LIGHTS = true; // some sphere has HOLDS_LIGHTS
layout(constant_id = 15) const bool PLANES_SHADOW = true;       // some plane has CASTS_SHADOWS
layout(constant_id = 16) const bool MIXED_ORDER = true; // a plane stands before a sphere in the file
layout(constant_id = 17) const bool ONE_ROUGHNESS = false; // all matte surfaces have view.matte
layout(constant_id = 18) const uint PLANE_AXES = 0u; // two bits a plane: normal along x 1, y 2, z 3, other 0
layout(constant_id = 19) const uint COLUMNS = 1u; // pixels an invocation renders, a group's width apart
RARE(20) const bool COUNTS = false; // what a pixel's values are, see pixel.glsl
RARE(21) const bool PRUNES = false; // rays are left out within the view's allowance

RARE(22) const bool CHARGES = false; // pixels tell what they are charged for rays that are not traced
layout(constant_id = 23) const bool RESUMABLE = false;  // see resume.glsl
RARE(24) const bool RAYS_ESCAPE = false; // see escape.glsl
RARE(25) const bool PROCESSOR = true; // the device is one, which runs invocations in the lanes of a vector
layout(constant_id = 26) const uint LIGHT_POINTS_A_TURN = ~0u; // of all lights, see shade.glsl
RARE(27) const uint GIANTS = 0u; // a bit for each sphere that is looped over: it is stored as a giant
RARE(28) const bool HOISTED = true; // see hoist_scene()
layout(constant_id = 29) const bool PRIMARY_RAYS_FIRST = true; // see render_primary_rays()
layout(constant_id = 30) const int ALL_SPHERES = 0; // those that are not looped over, too; see hierarchy.glsl
layout(constant_id = 31) const uint MOST_STEPS = 0u; // of all searches in a dispatch

const bool SECONDARY_RAYS = (MIRRORS || GLASS) && MAX_BOUNCES > 0;
const bool RAYS_ENTER_SPHERES = GLASS || SPHERES_HOLD_RAYS;

#ifdef SCENE_IN_STORAGE
#define SCENE_ARRAY(slot, Type, name, count) \
    layout(std430, set = 0, binding = slot) readonly buffer Type##Block { Type name[]; }
#else
#define SCENE_ARRAY(slot, Type, name, count) \
    layout(std140, set = 0, binding = slot) uniform Type##Block { Type name[count + 1]; }
#endif

layout(std140, set = 0, binding = 0) uniform ViewBlock { PackedView view; };
SCENE_ARRAY(1, LoopedSphere, spheres, SPHERES);
SCENE_ARRAY(2, PackedPlane, planes, PLANES);
SCENE_ARRAY(3, PackedPointLight, point_lights, POINT_LIGHTS);
SCENE_ARRAY(4, PackedQuadLight, quad_lights, QUAD_LIGHTS);

// Mesa's lavapipe loads a uniform once for all lanes only outside of control flow, and lane by lane inside. So small
// scenes are hoisted: copied to variables first thing. Loops over them are unrolled, which makes registers of these.
// Drivers unroll them by themselves; made to unroll 400 objects, lavapipe's compiler takes minutes.
LoopedSphere hoisted_spheres[HOISTED ? SPHERES + 1 : 1];
PackedPlane hoisted_planes[HOISTED ? PLANES + 1 : 1];
PackedPointLight hoisted_point_lights[HOISTED ? POINT_LIGHTS + 1 : 1];
PackedQuadLight hoisted_quad_lights[HOISTED ? QUAD_LIGHTS + 1 : 1];
PackedView hoisted_view;

void hoist_scene()
{
    hoisted_view = view;
    if (!HOISTED)
        return;
    [[unroll]] for (int i = 0; i < SPHERES; ++i)
        hoisted_spheres[i] = spheres[i];
    [[unroll]] for (int i = 0; i < PLANES; ++i)
        hoisted_planes[i] = planes[i];
    [[unroll]] for (int i = 0; i < POINT_LIGHTS; ++i)
        hoisted_point_lights[i] = point_lights[i];
    [[unroll]] for (int i = 0; i < QUAD_LIGHTS; ++i)
        hoisted_quad_lights[i] = quad_lights[i];
}

// An element of the scene, or a member of one.
#define SCENE_GETTER(Type, get, name, member) \
    Type get(int i)                           \
    {                                         \
        if (HOISTED)                          \
            return hoisted_##name[i] member;  \
        return name[i] member;                \
    }
SCENE_GETTER(PackedSphere, get_sphere, spheres, .sphere)
SCENE_GETTER(PackedSurface, get_surface, spheres, .surface)
SCENE_GETTER(PackedPlane, get_plane, planes, )
SCENE_GETTER(PackedPointLight, get_point_light, point_lights, )
SCENE_GETTER(PackedQuadLight, get_quad_light, quad_lights, )
