// For tests, with -DINEXACT_NATIVE: a device whose division and square root err as much as Vulkan allows, each
// result moved by a number of units in the last place that depends on the operands: -2 to 2 for division, -8 to 8
// for the root.

uint noise(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

real moved(real x, int ulps)
{
    uint bits = floatBitsToUint(x);
    uint magnitude = bits & 0x7fffffffu;
    if (magnitude < 0x00800010u || magnitude >= 0x7f7ffff0u) // 0, about to be denormal or infinite, NaN
        return x;
    return uintBitsToFloat(bits + uint(ulps));
}

real native_quotient(real a, real b)
{
    exact real quotient = a / b;
    return moved(quotient, int(noise(floatBitsToUint(a) + noise(floatBitsToUint(b))) % 5u) - 2);
}

real native_root(real a)
{
    exact real root = sqrt(a);
    return moved(root, int(noise(floatBitsToUint(a)) % 17u) - 8);
}
