// Calls a function of the renderer's shaders on the inputs of one case. The build defines CALL as one of the
// call_...() below, the harness compares with what cpu_reference/ makes of the same words.
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

layout(local_size_x = 64) in;
layout(constant_id = 100) const uint INPUT_WORDS = 1u; // of a case
layout(constant_id = 101) const uint OUTPUT_WORDS = 1u;
layout(std430, set = 0, binding = 5) readonly buffer Inputs { uint inputs[]; };
layout(std430, set = 0, binding = 6) writeonly buffer Outputs { uint outputs[]; };

#include "function_words.glsl"

void call_divide()
{
    float a = read_real();
    float b = read_real();
    write_real(divide(a, b));
}

void call_square_root()
{
    write_real(square_root(read_real()));
}

void call_unit()
{
    write_vector(unit(read_vector()));
}

void call_hash()
{
    write_integer(hash(read_integer()));
}

void call_sobol_point()
{
    uint seed = read_integer();
    uint index = read_integer();
    float u, v;
    sequence_point(sequence_of(seed), index, u, v);
    write_real(u);
    write_real(v);
}

Hit no_hit()
{
    Hit none;
    none.distance = FARTHEST_HIT;
    none.surface = -1;
    none.from_inside = false;
    none.shape = vec4(0);
    none.parameters = vec4(0);
    none.oren_nayar_b = 0.0;
    none.kind = KIND_MATTE;
    none.file_order = 0;
    none.center_offset = vec3(0);
    none.half_chord = 0.0;
    return none;
}

void write_hit(Hit hit)
{
    bool met = hit.surface >= 0;
    write_integer(uint(met));
    write_real(met ? hit.distance : 0.0);
    write_integer(uint(met && hit.from_inside));
}

void write_hit_point(Ray ray, Hit hit)
{
    vec3 point, normal;
    hit_point(ray, hit, point, normal);
    bool met = hit.surface >= 0;
    write_integer(uint(met));
    write_vector(met ? point : vec3(0));
    write_vector(met ? normal : vec3(0));
}

Hit meet_read_sphere(Ray ray)
{
    hoisted_spheres[0] = read_sphere();
    Hit nearest = no_hit();
    meet_sphere(ray, 0, nearest);
    return nearest;
}

Hit meet_read_plane(Ray ray)
{
    hoisted_planes[0] = read_plane();
    Hit nearest = no_hit();
    meet_plane(ray, 0, nearest);
    return nearest;
}

void call_meet_sphere()
{
    write_hit(meet_read_sphere(read_ray()));
}

void call_meet_plane()
{
    write_hit(meet_read_plane(read_ray()));
}

void call_sphere_hit_point()
{
    Ray ray = read_ray();
    write_hit_point(ray, meet_read_sphere(ray));
}

void call_plane_hit_point()
{
    Ray ray = read_ray();
    write_hit_point(ray, meet_read_plane(ray));
}

void call_nearest_hit()
{
    Ray ray = read_ray();
    [[unroll]] for (int i = 0; i < SPHERES; ++i)
        hoisted_spheres[i] = read_sphere();
    [[unroll]] for (int i = 0; i < PLANES; ++i)
        hoisted_planes[i] = read_plane();
    Hit hit = nearest_hit(ray);
    write_integer(uint(hit.surface));
    write_integer(uint(hit.file_order));
    write_hit(hit);
    write_hit_point(ray, hit);
}

void call_sphere_shadows()
{
    Segment segment = read_segment();
    hoisted_spheres[0] = read_sphere();
    bool shadows = sphere_shadows(0, segment.from, segment.surface, segment.inward, segment.direction,
                                  segment.distance, segment.to);
    write_integer(uint(shadows));
}

void call_plane_shadows()
{
    Segment segment = read_segment();
    hoisted_planes[0] = read_plane();
    write_integer(uint(plane_shadows(0, segment.from, segment.surface, segment.to)));
}

void call_reflect()
{
    vec3 direction = read_vector();
    vec3 normal = read_vector();
    write_vector(reflected(direction, normal, read_real()));
}

Refraction read_refraction()
{
    vec3 direction = read_vector();
    vec3 normal = read_vector();
    float cos_in = read_real();
    float eta = read_real();
    float kappa = read_real();
    return refracted(direction, normal, cos_in, eta, kappa);
}

void call_refract()
{
    Refraction refraction = read_refraction();
    write_integer(uint(refraction.total));
    write_vector(refraction.total ? vec3(0) : refraction.direction);
}

void call_fresnel()
{
    Refraction refraction = read_refraction();
    write_integer(uint(refraction.total));
    write_real(refraction.total ? 0.0 : refraction.reflectance);
}

void call_oren_nayar()
{
    Matte matte = read_matte();
    vec3 to_light = read_vector();
    write_real(matte_factor(matte, to_light, read_real()));
}

void call_point_light()
{
    Matte matte = read_matte();
    vec3 light = read_vector();
    hoisted_spheres[0] = read_sphere();
    hoisted_planes[0] = read_plane();
    Tally tally = Tally(0u, 0u, 0u);
    vec3 to_light;
    write_real(point_irradiance(matte, light, to_light, tally));
    write_integer(tally.shadow_rays);
    write_vector(tally.shadow_rays > 0u ? to_light : vec3(0));
}

void call_quad_light()
{
    Matte matte = read_matte();
    PackedQuadLight light;
    light.corner = read_vec4();
    light.edge_u = read_vec4();
    light.edge_v = read_vec4();
    light.area_normal = read_vec4();
    light.radiance = read_vec4();
    hoisted_quad_lights[0] = light;
    uint seed = read_integer();
    uint pixel_sample = read_integer();
    hoisted_spheres[0] = read_sphere();
    hoisted_planes[0] = read_plane();
    Tally tally = Tally(0u, 0u, 0u);
    write_vector(quad_radiance(matte, 0, pixel_sample * uint(LIGHT_SAMPLES), seed, tally));
    write_integer(tally.shadow_rays);
}

// The last group's surplus invocations have buffer to read and write.
void main()
{
    next_input = gl_GlobalInvocationID.x * INPUT_WORDS;
    next_output = gl_GlobalInvocationID.x * OUTPUT_WORDS;
    CALL();
}
