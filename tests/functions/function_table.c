#include "function_table.h"

#include "call_reference.h"
#include "generate.h"

/* Of scene.glsl. */
enum {
    SPHERES = 2,
    PLANES = 3,
    QUAD_LIGHTS = 5,
    LIGHT_SAMPLES = 8,
    GLASS_PLANES = 11,
    ROUGH = 12,
    SPHERES_HOLD_RAYS = 13,
    SPHERES_HOLD_LIGHTS = 14,
    MIXED_ORDER = 16,
    PLANE_AXES = 18,
    ENTERED_SPHERES = 20,
};

const struct pass_constant common_constants[COMMON_CONSTANTS] = {
    {SPHERES, 1},
    {PLANES, 1},
    {QUAD_LIGHTS, 1},
    {LIGHT_SAMPLES, QUAD_LIGHT_SAMPLES},
};

#define NEVER_ENTERED                                                                                        \
    {SPHERES_HOLD_RAYS, 0}, {SPHERES_HOLD_LIGHTS, 0},                                                        \
    {                                                                                                        \
        ENTERED_SPHERES, 0                                                                                   \
    }

const struct function_test function_tests[] = {
    {"divide", "divide", {0}, {{0}}, generate_quotient, call_divide},
    {"square_root", "square_root", {0}, {{0}}, generate_root, call_square_root},
    {"unit", "unit", {0}, {{0}}, generate_vector, call_unit},
    {"hash", "hash", {0}, {{0}}, generate_hash, call_hash},
    {"sobol_point", "sobol_point", {0}, {{0}}, generate_sobol, call_sobol_point},
    {"meet_sphere", "meet_sphere", {0}, {{0}}, generate_sphere_ray, call_meet_sphere},
    {"meet_sphere/never_entered",
     "meet_sphere",
     {.never_entered = true},
     {NEVER_ENTERED},
     generate_sphere_ray,
     call_meet_sphere},
    {"meet_plane", "meet_plane", {0}, {{0}}, generate_plane_ray, call_meet_plane},
    {"meet_plane/opaque",
     "meet_plane",
     {.opaque_planes = true},
     {{GLASS_PLANES, 0}},
     generate_plane_ray,
     call_meet_plane},
    {"meet_plane/axis_x", "meet_plane", {.axis = 1}, {{PLANE_AXES, 1}}, generate_plane_ray, call_meet_plane},
    {"meet_plane/axis_y", "meet_plane", {.axis = 2}, {{PLANE_AXES, 2}}, generate_plane_ray, call_meet_plane},
    {"meet_plane/axis_z", "meet_plane", {.axis = 3}, {{PLANE_AXES, 3}}, generate_plane_ray, call_meet_plane},
    {"hit_point/sphere", "sphere_hit_point", {0}, {{0}}, generate_sphere_ray, call_sphere_hit_point},
    {"hit_point/plane", "plane_hit_point", {0}, {{0}}, generate_plane_ray, call_plane_hit_point},
    {"nearest_hit", "nearest_hit", {0}, {{SPHERES, 2}, {PLANES, 2}}, generate_scene_ray, call_nearest_hit},
    {"nearest_hit/in_order",
     "nearest_hit",
     {.in_order = true},
     {{SPHERES, 2}, {PLANES, 2}, {MIXED_ORDER, 0}},
     generate_scene_ray,
     call_nearest_hit},
    {"sphere_shadows", "sphere_shadows", {0}, {{0}}, generate_sphere_segment, call_sphere_shadows},
    {"sphere_shadows/never_entered",
     "sphere_shadows",
     {.never_entered = true},
     {NEVER_ENTERED},
     generate_sphere_segment,
     call_sphere_shadows},
    {"plane_shadows", "plane_shadows", {0}, {{0}}, generate_plane_segment, call_plane_shadows},
    {"plane_shadows/opaque",
     "plane_shadows",
     {.opaque_planes = true},
     {{GLASS_PLANES, 0}},
     generate_plane_segment,
     call_plane_shadows},
    {"reflect", "reflect", {0}, {{0}}, generate_reflection, call_reflect},
    {"refract", "refract", {0}, {{0}}, generate_refraction, call_refract},
    {"fresnel", "fresnel", {0}, {{0}}, generate_refraction, call_fresnel},
    {"oren_nayar", "oren_nayar", {0}, {{0}}, generate_oren_nayar, call_oren_nayar},
    {"oren_nayar/lambert",
     "oren_nayar",
     {.lambert = true},
     {{ROUGH, 0}},
     generate_oren_nayar,
     call_oren_nayar},
    {"point_light", "point_light", {0}, {{0}}, generate_point_light, call_point_light},
    {"quad_light", "quad_light", {0}, {{0}}, generate_quad_light, call_quad_light},
};
const size_t function_test_count = sizeof function_tests / sizeof *function_tests;
