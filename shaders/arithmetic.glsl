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
#else
#define real float
#define real3 vec3
#endif

real dot3(real3 a, real3 b)
{
#ifdef FAST
    return dot(a, b);
#else
    exact real sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
#endif
}

real3 along(real3 origin, real distance, real3 direction)
{
    exact real3 point = origin + distance * direction;
    return point;
}

// Unit vector of v, by one division.
real3 unit(real3 v)
{
#ifdef FAST
    return normalize(v);
#else
    exact real inverse_length = real(1.0) / sqrt(dot3(v, v));
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
