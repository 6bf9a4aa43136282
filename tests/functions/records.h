/* The inputs and outputs of each function that functions.comp calls, described once: C and GLSL make structs
 * of these lists, and the harness makes the text from which it prints them. All members are 32-bit words, or
 * structs of such without gaps, so that std430 agrees with C. */
#ifndef RECORDS_H
#define RECORDS_H

#define MAKE_MEMBER(type, name) type name;

#ifdef VULKAN /* defined by glslang */
#define STRUCT(name, LIST)                                                                                   \
    struct name {                                                                                            \
        LIST(MAKE_MEMBER)                                                                                    \
    };
struct Vector {
    float x, y, z;
};
struct Vector4 {
    float x, y, z, w;
};
struct Tags {
    int x, y, z, w;
};
struct Surface {
    Vector4 parameters, more_parameters;
    Tags tags;
};
struct Sphere {
    Vector4 center_radius;
    Tags tags;
};
struct Plane {
    Vector4 normal_offset;
    Surface surface;
};
struct QuadLight {
    Vector4 corner, edge_u, edge_v, area_normal, radiance;
};
#else
#include "geometry.h"
#define STRUCT(name, LIST)                                                                                   \
    typedef struct {                                                                                         \
        LIST(MAKE_MEMBER)                                                                                    \
    } name;
typedef struct vec3 Vector;
typedef struct PackedSphere Sphere;
typedef struct PackedPlane Plane;
typedef struct PackedQuadLight QuadLight;
#endif

#define RAY(MEMBER) MEMBER(Vector, origin) MEMBER(Vector, direction) MEMBER(int, surface) MEMBER(int, inward)
#define HIT(MEMBER)                                                                                          \
    MEMBER(int, met)                                                                                         \
    MEMBER(float, distance) MEMBER(int, from_inside) MEMBER(Vector, point) MEMBER(Vector, normal)
#define SEGMENT(MEMBER)                                                                                      \
    MEMBER(Vector, from)                                                                                     \
    MEMBER(Vector, to)                                                                                       \
    MEMBER(Vector, direction) MEMBER(float, distance) MEMBER(int, surface) MEMBER(int, inward)
#define MATTE(MEMBER)                                                                                        \
    MEMBER(Vector, point)                                                                                    \
    MEMBER(Vector, normal)                                                                                   \
    MEMBER(Vector, ray_direction)                                                                            \
    MEMBER(float, cos_out) MEMBER(int, surface) MEMBER(int, inward) MEMBER(float, a) MEMBER(float, b)
STRUCT(RayRecord, RAY)
STRUCT(HitRecord, HIT)
STRUCT(SegmentRecord, SEGMENT)
STRUCT(MatteRecord, MATTE)

#define INPUT_unit(MEMBER) MEMBER(Vector, vector)
#define OUTPUT_unit(MEMBER) MEMBER(Vector, unit_vector)

#define INPUT_sobol_point(MEMBER) MEMBER(int, seed) MEMBER(int, index)
#define OUTPUT_sobol_point(MEMBER) MEMBER(float, u) MEMBER(float, v)

#define INPUT_meet_sphere(MEMBER) MEMBER(RayRecord, ray) MEMBER(Sphere, sphere) MEMBER(float, curvature)
#define OUTPUT_meet_sphere(MEMBER) MEMBER(HitRecord, hit)

#define INPUT_meet_plane(MEMBER) MEMBER(RayRecord, ray) MEMBER(Plane, plane)
#define OUTPUT_meet_plane(MEMBER) MEMBER(HitRecord, hit)

#define INPUT_nearest_hit(MEMBER)                                                                            \
    MEMBER(RayRecord, ray)                                                                                   \
    MEMBER(Sphere, sphere_0) MEMBER(Sphere, sphere_1) MEMBER(Plane, plane_0) MEMBER(Plane, plane_1)
#define OUTPUT_nearest_hit(MEMBER) MEMBER(int, surface) MEMBER(int, file_order) MEMBER(HitRecord, hit)

#define INPUT_sphere_shadows(MEMBER)                                                                         \
    MEMBER(SegmentRecord, segment) MEMBER(Sphere, sphere) MEMBER(float, curvature)
#define OUTPUT_sphere_shadows(MEMBER) MEMBER(int, shadows)

#define INPUT_plane_shadows(MEMBER) MEMBER(SegmentRecord, segment) MEMBER(Plane, plane)
#define OUTPUT_plane_shadows(MEMBER) MEMBER(int, shadows)

#define INPUT_reflect(MEMBER) MEMBER(Vector, direction) MEMBER(Vector, normal) MEMBER(float, cos_in)
#define OUTPUT_reflect(MEMBER) MEMBER(Vector, reflected_direction)

#define INPUT_refract(MEMBER) INPUT_reflect(MEMBER) MEMBER(float, eta) MEMBER(float, kappa)
#define OUTPUT_refract(MEMBER)                                                                               \
    MEMBER(int, total) MEMBER(Vector, refracted_direction) MEMBER(float, reflectance)

#define INPUT_oren_nayar(MEMBER) MEMBER(MatteRecord, matte) MEMBER(Vector, to_light) MEMBER(float, cos_in)
#define OUTPUT_oren_nayar(MEMBER) MEMBER(float, factor)

#define INPUT_point_light(MEMBER)                                                                            \
    MEMBER(MatteRecord, matte) MEMBER(Vector, light) MEMBER(Sphere, sphere) MEMBER(Plane, plane)
#define OUTPUT_point_light(MEMBER) MEMBER(float, irradiance) MEMBER(int, shadow_rays) MEMBER(Vector, to_light)

#define INPUT_quad_light(MEMBER)                                                                             \
    MEMBER(MatteRecord, matte)                                                                               \
    MEMBER(QuadLight, light)                                                                                 \
    MEMBER(int, seed) MEMBER(int, pixel_sample) MEMBER(Sphere, sphere) MEMBER(Plane, plane)
#define OUTPUT_quad_light(MEMBER) MEMBER(Vector, radiance) MEMBER(int, shadow_rays)

#define FUNCTIONS(DO)                                                                                        \
    DO(unit)                                                                                                 \
    DO(sobol_point)                                                                                          \
    DO(meet_sphere)                                                                                          \
    DO(meet_plane)                                                                                           \
    DO(nearest_hit)                                                                                          \
    DO(sphere_shadows) DO(plane_shadows) DO(reflect) DO(refract) DO(oren_nayar) DO(point_light) DO(quad_light)

#define MAKE_RECORDS(name)                                                                                   \
    STRUCT(name##_input, INPUT_##name)                                                                       \
    STRUCT(name##_output, OUTPUT_##name)
FUNCTIONS(MAKE_RECORDS)

#endif
