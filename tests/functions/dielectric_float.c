#include "dielectric_float.h"

#include "dielectric.h"
#include "packed_glass.h"

static struct vec3 vector(const float v[3])
{
    return (struct vec3){v[0], v[1], v[2]};
}

static void store(struct vec3 v, float stored[3])
{
    stored[0] = v.x;
    stored[1] = v.y;
    stored[2] = v.z;
}

static real cosine(struct vec3 direction, struct vec3 normal)
{
    return at_least_zero(-dot(normal, direction));
}

void reflect_float(const float direction[3], const float normal[3], float reflected[3])
{
    struct vec3 d = vector(direction), n = vector(normal);
    store(reflect(d, n, cosine(d, n)), reflected);
}

bool refract_float(const float direction[3], const float normal[3], double ior, bool entering,
                   float refracted[3])
{
    struct vec3 d = vector(direction), n = vector(normal);
    struct packed_glass glass = pack_glass(ior, entering);
    struct refraction refraction = refract(d, n, cosine(d, n), glass.eta, glass.kappa);
    store(refraction.direction, refracted);
    return !refraction.total;
}
