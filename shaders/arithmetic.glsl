// Numbers and vectors of the traced path. `exact` forbids contraction and rewriting; it has to stand on
// every local of every function, because `precise` does not pass through parameters and returned values.

#ifdef FAST
#define exact
#else
#define exact precise
#endif

#ifdef DOUBLE
#define real double
#define real3 dvec3
#define real4 dvec4
#else
#define real float
#define real3 vec3
#define real4 vec4
#endif

#ifdef INEXACT_NATIVE
#include "inexact_native.glsl"
#else
real native_quotient(real a, real b)
{
    exact real quotient = a / b;
    return quotient;
}

real native_root(real a)
{
    exact real root = sqrt(a);
    return root;
}
#endif

#ifdef CORRECTED
#include "corrected.glsl"
layout(constant_id = 32) const bool CORRECTED_DIVISION = true; // not so on NVIDIA's devices, where only sqrt is inexact
#endif

// a / b and the root of a, correctly rounded except with FAST: by the device itself or, for a device that is not
// exact (see host/vulkan/probe.h), corrected.
real divide(real a, real b)
{
#ifdef CORRECTED
    return CORRECTED_DIVISION ? corrected_quotient(a, b) : native_quotient(a, b);
#else
    return native_quotient(a, b);
#endif
}

real square_root(real a)
{
#ifdef CORRECTED
    return corrected_root(a);
#else
    return native_root(a);
#endif
}

real dot3(real3 a, real3 b)
{
#ifdef FAST
    return dot(a, b);
#else
    exact real sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
#endif
}

// Unit vector of v, by one division.
real3 unit(real3 v)
{
#ifdef FAST
    return normalize(v);
#else
    exact real inverse_length = divide(real(1), square_root(dot3(v, v)));
    exact real3 direction = v * inverse_length;
    return direction;
#endif
}

// v is a unit vector but for rounding; one Newton step towards length 1, so that the error does not
// grow from bounce to bounce.
real3 renormalized(real3 v)
{
    exact real scale = real(1.5) - real(0.5) * dot3(v, v);
    exact real3 direction = v * scale;
    return direction;
}
