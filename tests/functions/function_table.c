#include "function_table.h"

/* Of scene.glsl. */
enum {
    SPHERES = 2,
    PLANES = 3,
    QUAD_LIGHTS = 5,
    LIGHT_SAMPLES = 8,
    GLASS = 10,
    GLASS_PLANES = 11,
    ROUGH = 12,
    SPHERES_HOLD_RAYS = 13,
    SPHERES_HOLD_LIGHTS = 14,
    MIXED_ORDER = 16,
    PLANE_AXES = 18,
    GIANTS = 27,
    ALL_SPHERES = 30,
};

const struct pass_constant common_constants[COMMON_CONSTANTS] = {
    {SPHERES, 1}, {ALL_SPHERES, 1}, {PLANES, 1}, {QUAD_LIGHTS, 1}, {LIGHT_SAMPLES, QUAD_LIGHT_SAMPLES},
};

#define UNTYPED(name)                                                                                        \
    static void generate_untyped_##name(struct random *random, void *input)                                  \
    {                                                                                                        \
        generate_##name(random, input);                                                                      \
    }                                                                                                        \
    static void call_untyped_##name(const void *input, void *output)                                         \
    {                                                                                                        \
        call_##name(input, output);                                                                          \
    }                                                                                                        \
    _Static_assert(sizeof(name##_input) <= MOST_WORDS * sizeof(union word), "MOST_WORDS");
FUNCTIONS(UNTYPED)

/* A record as text: "NAME:LETTERS " for each member, with a letter a word, f for a float and i for an
 * integer, after "NAME " where it is a record itself. */
#define TEXT(type, name) #name TEXT_##type " "
#define INNER_TEXT(type, name) #name TEXT_##type " "
#define TEXT_float ":f"
#define TEXT_int ":i"
#define TEXT_Vector ":fff"
#define TEXT_Sphere ":ffff tags:iiii"
#define TEXT_Plane ":ffff parameters:ffff more_parameters:ffff tags:iiii"
#define TEXT_QuadLight ":ffff edge_u:ffff edge_v:ffff area_normal:ffff radiance:ffff"
#define TEXT_RayRecord " " RAY(INNER_TEXT)
#define TEXT_HitRecord " " HIT(INNER_TEXT)
#define TEXT_SegmentRecord " " SEGMENT(INNER_TEXT)
#define TEXT_MatteRecord " " MATTE(INNER_TEXT)

/* The constants are the further arguments. */
#define TEST(name_, variant, promise, ...)                                                                   \
    {                                                                                                        \
        .name = #name_ variant, .function = #name_,                                                          \
        .input_words = sizeof(name_##_input) / sizeof(union word),                                           \
        .output_words = sizeof(name_##_output) / sizeof(union word), .inputs = INPUT_##name_(TEXT),          \
        .outputs = OUTPUT_##name_(TEXT), .promises = {promise}, .constants = {__VA_ARGS__},                  \
        .generate = generate_untyped_##name_, .call = call_untyped_##name_,                                  \
    }
#define GENERAL(name) TEST(name, "", 0, {0})
#define NEVER_ENTERED                                                                                        \
    {SPHERES_HOLD_RAYS, 0}, {SPHERES_HOLD_LIGHTS, 0},                                                        \
    {                                                                                                        \
        GLASS, 0                                                                                             \
    }
#define GIANT_NEVER_ENTERED .giant = true, .never_entered = true
#define TWO_OF_EACH                                                                                          \
    {SPHERES, 2}, {ALL_SPHERES, 2},                                                                          \
    {                                                                                                        \
        PLANES, 2                                                                                            \
    }

const struct function_test function_tests[] = {
    GENERAL(unit),
    GENERAL(sobol_point),
    GENERAL(meet_sphere),
    TEST(meet_sphere, "/never_entered", .never_entered = true, NEVER_ENTERED),
    TEST(meet_sphere, "/giant", .giant = true, {GIANTS, 1}),
    TEST(meet_sphere, "/giant_never_entered", GIANT_NEVER_ENTERED, NEVER_ENTERED, {GIANTS, 1}),
    GENERAL(meet_plane),
    TEST(meet_plane, "/opaque", .opaque_planes = true, {GLASS_PLANES, 0}),
    TEST(meet_plane, "/axis_x", .axis = 1, {PLANE_AXES, 1}),
    TEST(meet_plane, "/axis_y", .axis = 2, {PLANE_AXES, 2}),
    TEST(meet_plane, "/axis_z", .axis = 3, {PLANE_AXES, 3}),
    TEST(nearest_hit, "", 0, TWO_OF_EACH),
    TEST(nearest_hit, "/in_order", .in_order = true, TWO_OF_EACH, {MIXED_ORDER, 0}),
    GENERAL(sphere_shadows),
    TEST(sphere_shadows, "/never_entered", .never_entered = true, NEVER_ENTERED),
    TEST(sphere_shadows, "/giant", .giant = true, {GIANTS, 1}),
    TEST(sphere_shadows, "/giant_never_entered", GIANT_NEVER_ENTERED, NEVER_ENTERED, {GIANTS, 1}),
    GENERAL(plane_shadows),
    TEST(plane_shadows, "/opaque", .opaque_planes = true, {GLASS_PLANES, 0}),
    GENERAL(reflect),
    GENERAL(refract),
    GENERAL(oren_nayar),
    TEST(oren_nayar, "/lambert", .lambert = true, {ROUGH, 0}),
    GENERAL(point_light),
    GENERAL(quad_light),
};
const size_t function_test_count = sizeof function_tests / sizeof *function_tests;
