// For tests, with -DINEXACT_NATIVE: a device whose division and square root err as much as Vulkan allows, each
// result moved by a number of units in the last place that depends on the operands, up to these to either side.
#ifndef DIVISION_ULPS
#define DIVISION_ULPS 2
#endif
#ifndef ROOT_ULPS
#define ROOT_ULPS 8
#endif

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
    if (magnitude < 0x00800100u || magnitude >= 0x7f7fff00u) // 0, about to be denormal or infinite, NaN
        return x;
    return uintBitsToFloat(bits + uint(ulps));
}

real native_quotient(real a, real b)
{
    exact real quotient = a / b;
    uint choice = noise(floatBitsToUint(a) + noise(floatBitsToUint(b))) % uint(2 * DIVISION_ULPS + 1);
    return moved(quotient, int(choice) - DIVISION_ULPS);
}

real native_root(real a)
{
    exact real root = sqrt(a);
    uint choice = noise(floatBitsToUint(a)) % uint(2 * ROOT_ULPS + 1);
    return moved(root, int(choice) - ROOT_ULPS);
}
