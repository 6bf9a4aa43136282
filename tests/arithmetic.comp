// Quotient of a and b and square root of a for each pair of bit patterns that it is given; see unit_arithmetic.c.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "arithmetic.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Operands { uvec2 operands[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { uvec2 results[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    float a = uintBitsToFloat(operands[i].x);
    float b = uintBitsToFloat(operands[i].y);
    results[i] = uvec2(floatBitsToUint(divide(a, b)), floatBitsToUint(square_root(a)));
}
