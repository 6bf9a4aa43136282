// Calls a function of the renderer's shaders on the inputs of one case. The build defines CALL as one of the functions
// of records.h; the harness compares with what cpu_reference/ makes of the same inputs.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "scene.glsl"
#include "arithmetic.glsl"
#include "events.glsl"
#include "sampling.glsl"
#include "tally.glsl"
#include "intersect.glsl"
#include "shade.glsl"
#include "dielectric.glsl"
#include "records.h"

#define PASTE_EXPANDED(a, b) a##b
#define PASTE(a, b) PASTE_EXPANDED(a, b)

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 8) readonly buffer Inputs { PASTE(CALL, _input) inputs[]; };
layout(std430, set = 0, binding = 9) writeonly buffer Outputs { PASTE(CALL, _output) outputs[]; };

vec3 vec3_of(Vector v)
{
    return vec3(v.x, v.y, v.z);
}

vec4 vec4_of(Vector4 v)
{
    return vec4(v.x, v.y, v.z, v.w);
}

Vector vector_of(vec3 v)
{
    return Vector(v.x, v.y, v.z);
}

PackedSurface surface_of(Surface surface)
{
    return PackedSurface(vec4_of(surface.parameters), vec4_of(surface.more_parameters),
                         ivec4(surface.tags.x, surface.tags.y, surface.tags.z, surface.tags.w));
}

PackedSphere sphere_of(Sphere sphere)
{
    return PackedSphere(vec4_of(sphere.center_radius),
                        ivec4(sphere.tags.x, sphere.tags.y, sphere.tags.z, sphere.tags.w));
}

PackedPlane plane_of(Plane plane)
{
    return PackedPlane(vec4_of(plane.normal_offset), surface_of(plane.surface));
}

Ray ray_of(RayRecord ray)
{
    return Ray(vec3_of(ray.origin), vec3_of(ray.direction), ray.surface, ray.inward != 0);
}

Matte matte_of(MatteRecord matte)
{
    return Matte(vec3_of(matte.point), vec3_of(matte.normal), vec3_of(matte.ray_direction), matte.cos_out,
                 matte.surface, matte.inward != 0, matte.a, matte.b);
}

void call_unit(unit_input i, out unit_output o)
{
    o.unit_vector = vector_of(unit(vec3_of(i.vector)));
}

void call_sobol_point(sobol_point_input i, out sobol_point_output o)
{
    sequence_point(sequence_of(uint(i.seed)), uint(i.index), o.u, o.v);
}

// All 0 where nothing was met.
HitRecord record_of(Ray ray, Hit hit)
{
    vec3 point, normal;
    hit_point(ray, hit, point, normal);
    if (hit.surface < 0)
        return HitRecord(0, 0.0, 0, Vector(0, 0, 0), Vector(0, 0, 0));
    return HitRecord(1, hit.distance, int(hit.from_inside), vector_of(point), vector_of(normal));
}

// Sphere 0; one that is a giant, where the pipeline has such, has a curvature.
void set_sphere(Sphere sphere, float curvature)
{
    PackedSurface surface = PackedSurface(vec4(0), vec4(0), ivec4(0));
    surface.more_parameters.CURVATURE = curvature;
    hoisted_spheres[0] = LoopedSphere(sphere_of(sphere), surface);
}

void call_meet_sphere(meet_sphere_input i, out meet_sphere_output o)
{
    set_sphere(i.sphere, i.curvature);
    Hit nearest = no_hit();
    if (is_giant(0))
        meet_giant(ray_of(i.ray), 0, nearest);
    else
        meet_sphere(ray_of(i.ray), 0, nearest);
    o.hit = record_of(ray_of(i.ray), nearest);
}

void call_meet_plane(meet_plane_input i, out meet_plane_output o)
{
    hoisted_planes[0] = plane_of(i.plane);
    Hit nearest = no_hit();
    meet_plane(ray_of(i.ray), 0, nearest);
    o.hit = record_of(ray_of(i.ray), nearest);
}

// Its pipeline has two spheres and two planes, those of the other functions one of each.
void call_nearest_hit(nearest_hit_input i, out nearest_hit_output o)
{
    hoisted_spheres[0].sphere = sphere_of(i.sphere_0);
    hoisted_spheres[SPHERES - 1].sphere = sphere_of(i.sphere_1);
    hoisted_planes[0] = plane_of(i.plane_0);
    hoisted_planes[PLANES - 1] = plane_of(i.plane_1);
    Hit nearest = nearest_hit(ray_of(i.ray));
    o.surface = nearest.surface;
    o.file_order = nearest.file_order;
    o.hit = record_of(ray_of(i.ray), nearest);
}

void call_sphere_shadows(sphere_shadows_input i, out sphere_shadows_output o)
{
    set_sphere(i.sphere, i.curvature);
    vec3 from = vec3_of(i.segment.from), to = vec3_of(i.segment.to), direction = vec3_of(i.segment.direction);
    bool inward = i.segment.inward != 0;
    if (is_giant(0))
        o.shadows = int(giant_shadows(0, from, i.segment.surface, inward, direction, i.segment.distance, to));
    else
        o.shadows = int(sphere_shadows(0, from, i.segment.surface, inward, direction, i.segment.distance, to));
}

void call_plane_shadows(plane_shadows_input i, out plane_shadows_output o)
{
    hoisted_planes[0] = plane_of(i.plane);
    o.shadows = int(plane_shadows(0, vec3_of(i.segment.from), i.segment.surface, vec3_of(i.segment.to)));
}

void call_reflect(reflect_input i, out reflect_output o)
{
    o.reflected_direction = vector_of(reflected(vec3_of(i.direction), vec3_of(i.normal), i.cos_in));
}

void call_refract(refract_input i, out refract_output o)
{
    Refraction refraction = refracted(vec3_of(i.direction), vec3_of(i.normal), i.cos_in, i.eta, i.kappa);
    o.total = int(refraction.total);
    o.refracted_direction = vector_of(refraction.total ? vec3(0) : refraction.direction);
    o.reflectance = refraction.total ? 0.0 : refraction.reflectance;
}

void call_oren_nayar(oren_nayar_input i, out oren_nayar_output o)
{
    o.factor = matte_factor(matte_of(i.matte), vec3_of(i.to_light), i.cos_in);
}

void call_point_light(point_light_input i, out point_light_output o)
{
    hoisted_spheres[0].sphere = sphere_of(i.sphere);
    hoisted_planes[0] = plane_of(i.plane);
    Tally tally = Tally(0u, 0u, 0u);
    vec3 to_light;
    o.irradiance = point_irradiance(matte_of(i.matte), vec3_of(i.light), to_light, tally);
    o.shadow_rays = int(tally.shadow_rays);
    o.to_light = vector_of(tally.shadow_rays > 0u ? to_light : vec3(0));
}

void call_quad_light(quad_light_input i, out quad_light_output o)
{
    hoisted_spheres[0].sphere = sphere_of(i.sphere);
    hoisted_planes[0] = plane_of(i.plane);
    hoisted_quad_lights[0] =
        PackedQuadLight(vec4_of(i.light.corner), vec4_of(i.light.edge_u), vec4_of(i.light.edge_v),
                        vec4_of(i.light.area_normal), vec4_of(i.light.radiance));
    Tally tally = Tally(0u, 0u, 0u);
    o.radiance =
        vector_of(quad_radiance(matte_of(i.matte), 0, uint(i.pixel_sample), uint(i.seed), tally));
    o.shadow_rays = int(tally.shadow_rays);
}

// The last group's surplus invocations have buffer to read and write.
void main()
{
    PASTE(CALL, _output) result;
    PASTE(call_, CALL)(inputs[gl_GlobalInvocationID.x], result);
    outputs[gl_GlobalInvocationID.x] = result;
}
