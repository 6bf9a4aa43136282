// What the device's own arithmetic does with the operands that it is given; host/vulkan/probe.c judges the results.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "arithmetic.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Operands { float operands[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    float a = operands[3u * i];
    float b = operands[3u * i + 1u];
    float c = operands[3u * i + 2u];
    exact float sum = a + b;
    exact float difference = a - b;
    exact float product = a * b;
    exact float product_sum = a * b + c;
    exact float product_difference = c - a * b;

    results[8u * i] = divide(a, b);
    results[8u * i + 1u] = square_root(a < 0.0 ? -a : a);
    results[8u * i + 2u] = sum;
    results[8u * i + 3u] = difference;
    results[8u * i + 4u] = product;
    results[8u * i + 5u] = product_sum;
    results[8u * i + 6u] = product_difference;
    results[8u * i + 7u] = dot3(vec3(a, b, c), vec3(b, c, a));
}
