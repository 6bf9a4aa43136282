#include "scene/digest.h"

#include <string.h>

/* Each word is mixed in by a multiplication that is one-to-one and carries upwards, and a shift that carries
 * downwards, as in Vigna's splitmix64. */
static uint64_t mix(uint64_t digest, const void *items, size_t size, int count)
{
    const unsigned char *bytes = items;
    for (size_t i = 0; i < size * (size_t)count; i += sizeof(uint64_t)) {
        uint64_t word;
        memcpy(&word, bytes + i, sizeof word);
        digest = (digest ^ word) * UINT64_C(0xbf58476d1ce4e5b9);
        digest ^= digest >> 31;
    }
    return digest;
}

uint64_t pack_digest(const struct packed_scene *packed)
{
    const int64_t numbers[] = {
        packed->width,         packed->height,           packed->max_bounces, packed->samples,
        packed->light_samples, packed->sphere_count,     packed->plane_count, packed->point_light_count,
        packed->surface_count, packed->quad_light_count,
    };
    uint64_t digest = mix(0, numbers, sizeof numbers, 1);
    digest = mix(digest, &packed->view, sizeof packed->view, 1);
    digest = mix(digest, packed->spheres, sizeof *packed->spheres, packed->sphere_count);
    digest = mix(digest, packed->surfaces, sizeof *packed->surfaces, packed->surface_count);
    digest = mix(digest, packed->planes, sizeof *packed->planes, packed->plane_count);
    digest = mix(digest, packed->point_lights, sizeof *packed->point_lights, packed->point_light_count);
    return mix(digest, packed->quad_lights, sizeof *packed->quad_lights, packed->quad_light_count);
}
