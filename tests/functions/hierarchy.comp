// The nearest hit of a ray, and whether something stands in a segment's way, in a scene of many spheres. Every second
// case has few steps at a time, as where a dispatch ends.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "scene.glsl"
#include "arithmetic.glsl"
#include "events.glsl"
#include "sampling.glsl"
#include "tally.glsl"
#include "intersect.glsl"

layout(local_size_x = 64) in;

struct Input {
    vec4 origin_surface, direction_inward;
    vec4 from_surface, to_inward, direction_length;
};
struct Output {
    int surface, from_inside, blocked, rounds;
    vec4 distance;
};
layout(std430, set = 0, binding = 8) readonly buffer Inputs { Input inputs[]; };
layout(std430, set = 0, binding = 9) writeonly buffer Outputs { Output outputs[]; };

void main()
{
    hoist_scene();
    begin_hierarchy();
    uint i = gl_GlobalInvocationID.x, most = i % 2u == 0u ? 4000u : 5u;
    Ray ray = Ray(inputs[i].origin_surface.xyz, inputs[i].direction_inward.xyz, floatBitsToInt(inputs[i].origin_surface.w),
                  inputs[i].direction_inward.w != 0.0);
    Hit nearest;
    int rounds = 0;
    do {
        steps = most;
        nearest = nearest_hit(ray);
    } while (search.stage != SEARCH_DONE && ++rounds < 200);
    bool blocked;
    do {
        steps = most;
        blocked = in_shadow(inputs[i].from_surface.xyz, floatBitsToInt(inputs[i].from_surface.w), inputs[i].to_inward.w != 0.0,
                            inputs[i].direction_length.xyz, inputs[i].direction_length.w, inputs[i].to_inward.xyz);
    } while (out_of_steps && ++rounds < 400);
    outputs[i].surface = nearest.surface;
    outputs[i].from_inside = int(nearest.from_inside);
    outputs[i].blocked = int(blocked);
    outputs[i].rounds = rounds;
    outputs[i].distance = vec4(nearest.distance);
}
