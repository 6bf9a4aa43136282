/* Rays that escape: reflected between parallel mirrors for ever, they meet nothing else. */
#ifndef REFERENCE_ESCAPE_H
#define REFERENCE_ESCAPE_H

#include "geometry.h"

/* Whether the line from ray->origin meets the sphere or comes near it, with both projected along `normal`. `line`
 * is the ray's direction, projected likewise. */
static inline bool passes_near(const struct ray *ray, struct vec3 line, struct vec3 normal,
                               layout_vec4 sphere)
{
    struct vec3 to_center = subtract(vector_of(sphere), ray->origin);
    struct vec3 apart = subtract(to_center, scale(dot(to_center, normal), normal));
    real reach =
        sphere.w + (real)MIRROR_DRIFT * (absolute(apart.x) + absolute(apart.y) + absolute(apart.z) + 1);
    real reach_squared = reach * reach;
    real along = dot(apart, line);
    if (!(along > 0))
        return !(dot(apart, apart) > reach_squared);
    real beside = dot(apart, apart) * dot(line, line) - along * along;
    return !(beside > reach_squared * dot(line, line));
}

/* Whether the ray, which a mirror has just reflected, escapes. */
static inline bool escapes(const struct packed_scene *scene, const struct ray *ray)
{
    struct vec3 normal = vector_of(scene->view.between_mirrors);
    real towards_mirror = dot(ray->direction, normal);
    if (!(absolute(towards_mirror) > (real)MIRROR_DRIFT))
        return false;
    for (int i = 0; i < scene->plane_count; ++i)
        if (scene->planes[i].surface.tags.SURFACE_KIND != KIND_MIRROR &&
            !(dot(ray->direction, vector_of(scene->planes[i].normal_offset)) > (real)MIRROR_DRIFT))
            return false;
    struct vec3 line = subtract(ray->direction, scale(towards_mirror, normal));
    for (int i = 0; i < scene->sphere_count; ++i)
        if (passes_near(ray, line, normal, scene->spheres[i].center_radius))
            return false;
    return true;
}

#endif
