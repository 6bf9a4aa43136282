/* Rays against spheres and planes without tolerances: a ray knows the surface it leaves and the side it
 * leaves to; a point knows what it cannot be inside of. */
#ifndef REFERENCE_GEOMETRY_H
#define REFERENCE_GEOMETRY_H

#include <stdbool.h>

#include "giant.h"
#include "packed_scene.h"
#include "real.h"
#include "sphere_tree.h"

enum { NO_SURFACE = -1 }; /* surfaces are numbered spheres first, then planes */

struct ray {
    struct vec3 origin, direction; /* direction of length 1 */
    int surface;                   /* that the ray leaves, or NO_SURFACE */
    bool inward;                   /* into the sphere that it leaves */
};

struct hit {
    real distance;
    int surface;
    bool from_inside;          /* met from the inside of a sphere or the glass side of a transparent plane */
    struct vec3 point, normal; /* unit normal, facing the ray */
    const PackedSurface *material;
    int file_order;
};

/* The spheres that are tried one after the other: the first so many. */
static inline int tried_spheres(const struct packed_scene *scene)
{
    return scene->tree ? scene->looped_spheres : scene->sphere_count;
}

/* Whether the tree has the surface: it is tried by itself, for the tree does not know that a ray leaves it.
 */
static inline bool is_in_tree(const struct packed_scene *scene, int surface)
{
    return surface >= tried_spheres(scene) && surface < scene->sphere_count;
}

static inline struct tree_vector to_tree_vector(struct vec3 v)
{
    return (struct tree_vector){(double)v.x, (double)v.y, (double)v.z};
}

/* What binary128 loses when it is rounded to double for the tree. */
static inline double tree_rounding(struct vec3 v)
{
    return 0x1p-52 * (double)(absolute(v.x) + absolute(v.y) + absolute(v.z));
}

/* The unit roundoff of this build's arithmetic; the tree cannot tell binary128 from double. */
static const double real_unit = REFERENCE_BITS == 32 ? 0x1p-24 : 0x1p-53;

static inline struct tree_line tree_line(struct vec3 origin, struct vec3 direction)
{
    return (struct tree_line){
        .origin = to_tree_vector(origin),
        .direction = to_tree_vector(direction),
        .e_origin = tree_rounding(origin),
        .e_direction = tree_rounding(direction),
        .unit = real_unit,
    };
}

/* Where a line passes a sphere: Haines, Guenther and Akenine-Moeller, "Precision Improvements for
 * Ray/Sphere Intersection", Ray Tracing Gems (2019), chapter 7. */
struct approach {
    real along;                /* signed distance to the closest approach, the point nearest to the centre */
    struct vec3 center_offset; /* from there to the centre */
    real half_chord_squared;   /* > 0: the line meets the sphere */
};

static inline struct approach approach_sphere(struct vec3 to_center, struct vec3 direction, real radius)
{
    struct approach approach;
    approach.along = dot(to_center, direction);
    approach.center_offset = subtract(to_center, scale(approach.along, direction));
    approach.half_chord_squared = radius * radius - dot(approach.center_offset, approach.center_offset);
    return approach;
}

/* Whether the point lies inside sphere i. */
static inline bool lies_inside(const struct packed_scene *scene, int i, struct vec3 point)
{
    if (is_giant(scene, i)) {
        struct giant giant = giant_of(scene, i);
        return giant_height(&giant, point) < 0;
    }
    layout_vec4 sphere = scene->spheres[i].center_radius;
    struct vec3 to_center = subtract(vector_of(sphere), point);
    real radius = sphere.w;
    return dot(to_center, to_center) < radius * radius;
}

/* Distances along a line to a sphere's surface. */
struct passage {
    real near_end, far_end;
    real chord;  /* from a point of the surface on the line, inward, to the other */
    bool is_met; /* ahead, from outside */
};

static inline struct passage pass_sphere(layout_vec4 sphere, const struct ray *ray)
{
    struct approach approach =
        approach_sphere(subtract(vector_of(sphere), ray->origin), ray->direction, sphere.w);
    real half_chord = square_root(at_least_zero(approach.half_chord_squared));
    return (struct passage){
        .near_end = approach.along - half_chord,
        .far_end = at_least_zero(approach.along + half_chord),
        .chord = 2 * at_least_zero(approach.along),
        .is_met = approach.along > 0 && approach.half_chord_squared > 0,
    };
}

static inline struct passage pass_giant(const struct giant *giant, bool holds_rays, const struct ray *ray)
{
    struct giant_line line = giant_line(giant, ray->origin, ray->direction, holds_rays);
    real root = giant_root(&line), doubled = 2 * line.height;
    return (struct passage){
        .near_end = doubled / (root - line.slope),
        /* of the two ways to write the second root, the one that does not cancel */
        .far_end = line.slope > 0 ? -doubled / (line.slope + root) : (root - line.slope) / giant->curvature,
        .chord = 2 * at_least_zero(-line.slope) / giant->curvature,
        .is_met = line.slope < 0 && giant_is_crossed(&line),
    };
}

/* Whether the ray meets sphere i; the distance to where it does, and from which side. */
static inline bool meet_sphere(const struct packed_scene *scene, int i, const struct ray *ray, real *distance,
                               bool *from_inside)
{
    const bool own = ray->surface == i, holds_rays = scene->spheres[i].tags.HOLDS_RAYS != 0;
    struct passage passage;
    if (is_giant(scene, i)) {
        struct giant giant = giant_of(scene, i);
        passage = pass_giant(&giant, holds_rays, ray);
    } else {
        passage = pass_sphere(scene->spheres[i].center_radius, ray);
    }
    *from_inside = own || (holds_rays && lies_inside(scene, i, ray->origin));
    *distance = own ? passage.chord : *from_inside ? passage.far_end : passage.near_end;
    if (own) /* inward, the way is a whole chord; outward, there is no way back */
        return ray->inward;
    return *from_inside || passage.is_met;
}

static inline bool meet_plane(const struct PackedPlane *plane, int surface, const struct ray *ray,
                              real *distance, bool *from_inside)
{
    if (ray->surface == surface)
        return false;
    struct vec3 normal = vector_of(plane->normal_offset);
    real slope = dot(normal, ray->direction);
    real height = dot(normal, ray->origin) - plane->normal_offset.w;
    if (plane->surface.tags.SURFACE_KIND == KIND_TRANSPARENT) {
        *from_inside = slope > 0;
        *distance = height / -slope;
        return *from_inside ? slope > (real)PARALLEL && height < 0 : slope < -(real)PARALLEL && height > 0;
    }
    *from_inside = false;
    *distance = at_least_zero(height) / -slope; /* the origin is in front of every opaque plane */
    return slope < -(real)PARALLEL;
}

/* Puts the hit's point on its surface, whatever error the distance has, and finds the normal. */
static inline void locate(const struct packed_scene *scene, const struct ray *ray, struct hit *hit)
{
    struct vec3 normal;
    if (is_giant(scene, hit->surface)) {
        struct giant giant = giant_of(scene, hit->surface);
        struct vec3 point = add(ray->origin, scale(hit->distance, ray->direction));
        struct vec3 gradient = giant_gradient(&giant, point);
        normal = normalize(gradient);
        hit->point = subtract(point, scale(giant_height(&giant, point), gradient));
    } else if (hit->surface < scene->sphere_count) {
        layout_vec4 shape = scene->spheres[hit->surface].center_radius;
        struct vec3 center = vector_of(shape);
        struct approach approach = approach_sphere(subtract(center, ray->origin), ray->direction, shape.w);
        real half_chord = square_root(at_least_zero(approach.half_chord_squared));
        if (hit->from_inside)
            half_chord = -half_chord;
        normal = normalize(negate(add(approach.center_offset, scale(half_chord, ray->direction))));
        hit->point = add(center, scale(shape.w, normal));
    } else {
        layout_vec4 shape = scene->planes[hit->surface - scene->sphere_count].normal_offset;
        normal = vector_of(shape);
        struct vec3 point = add(ray->origin, scale(hit->distance, ray->direction));
        hit->point = subtract(point, scale(dot(normal, point) - shape.w, normal));
    }
    hit->normal = hit->from_inside ? negate(normal) : normal;
}

/* Of surfaces at one distance the first of the scene file is the nearest. */
static inline void take_if_nearer(struct hit *nearest, real distance, int surface, bool from_inside,
                                  const PackedSurface *material, int file_order)
{
    if (distance < nearest->distance || (distance == nearest->distance && nearest->surface != NO_SURFACE &&
                                         file_order < nearest->file_order)) {
        nearest->distance = distance;
        nearest->surface = surface;
        nearest->from_inside = from_inside;
        nearest->material = material;
        nearest->file_order = file_order;
    }
}

static inline void try_sphere(const struct packed_scene *scene, int i, const struct ray *ray,
                              struct hit *nearest)
{
    const layout_ivec4 tags = scene->spheres[i].tags;
    real distance;
    bool from_inside;
    if (meet_sphere(scene, i, ray, &distance, &from_inside))
        take_if_nearer(nearest, distance, i, from_inside, &scene->surfaces[tags.SURFACE], tags.FILE_ORDER);
}

/* Tries those that the tree does not rule out. */
static inline void search_tree(const struct packed_scene *scene, const struct ray *ray, struct hit *nearest)
{
    if (is_in_tree(scene, ray->surface))
        try_sphere(scene, ray->surface, ray, nearest);
    const struct tree_line line = tree_line(ray->origin, ray->direction);
    struct sphere_walk walk = sphere_walk_begin(scene->tree, &line, (double)nearest->distance);
    for (int i; (i = sphere_walk_next(&walk)) != NO_MORE_SPHERES;) {
        try_sphere(scene, i, ray, nearest);
        walk.limit = (double)nearest->distance;
    }
}

/* The nearest surface on the ray's way; of surfaces at one distance the first of the scene file. */
static inline bool find_hit(const struct packed_scene *scene, const struct ray *ray, struct hit *nearest)
{
    *nearest = (struct hit){.distance = (real)FARTHEST_HIT, .surface = NO_SURFACE};
    for (int i = 0; i < tried_spheres(scene); ++i)
        try_sphere(scene, i, ray, nearest);
    for (int i = 0; i < scene->plane_count; ++i) {
        const struct PackedPlane *plane = &scene->planes[i];
        int surface = scene->sphere_count + i;
        real distance;
        bool from_inside;
        if (meet_plane(plane, surface, ray, &distance, &from_inside))
            take_if_nearer(nearest, distance, surface, from_inside, &plane->surface,
                           plane->surface.tags.FILE_ORDER);
    }
    if (scene->tree)
        search_tree(scene, ray, nearest);
    if (nearest->surface == NO_SURFACE)
        return false;
    locate(scene, ray, nearest);
    return true;
}

/* The way from a surface point to a point of a light. */
struct segment {
    struct vec3 from, to, direction;
    real length;
    int surface; /* that `from` lies on */
    bool inward; /* on the inner side of that sphere */
};

/* Whether sphere i stands between the ends. */
static inline bool sphere_blocks(const struct packed_scene *scene, int i, const struct segment *segment)
{
    const layout_ivec4 tags = scene->spheres[i].tags;
    const bool own = segment->surface == i;
    if (own && !segment->inward)
        return false;
    bool starts_inside = own || (tags.HOLDS_RAYS != 0 && lies_inside(scene, i, segment->from));
    bool ends_inside = tags.HOLDS_LIGHTS != 0 && lies_inside(scene, i, segment->to);
    if (starts_inside || ends_inside)
        return starts_inside != ends_inside;
    if (is_giant(scene, i)) {
        struct giant giant = giant_of(scene, i);
        struct giant_line line = giant_line(&giant, segment->from, segment->direction, tags.HOLDS_RAYS != 0);
        return line.slope < 0 && giant_is_crossed(&line) && -line.slope < giant.curvature * segment->length;
    }
    layout_vec4 sphere = scene->spheres[i].center_radius;
    struct approach approach =
        approach_sphere(subtract(vector_of(sphere), segment->from), segment->direction, sphere.w);
    return approach.along > 0 && approach.half_chord_squared > 0 && approach.along < segment->length;
}

/* A segment crosses a plane exactly when its ends lie on different sides; `from` is known to lie in front
 * of every opaque plane. */
static inline bool plane_blocks(const struct PackedPlane *plane, int surface, const struct segment *segment)
{
    if (plane->surface.tags.CASTS_SHADOWS == 0)
        return false;
    struct vec3 normal = vector_of(plane->normal_offset);
    bool ends_behind = dot(normal, segment->to) - plane->normal_offset.w < 0;
    if (plane->surface.tags.SURFACE_KIND != KIND_TRANSPARENT)
        return ends_behind;
    bool starts_behind = dot(normal, segment->from) - plane->normal_offset.w < 0;
    return segment->surface != surface && starts_behind != ends_behind;
}

/* As find_blocker(), of the spheres that the tree has. */
static inline int find_blocker_in_tree(const struct packed_scene *scene, const struct segment *segment,
                                       bool any)
{
    int own = segment->surface, first = NO_SURFACE;
    if (is_in_tree(scene, own) && sphere_blocks(scene, own, segment))
        first = own;
    struct tree_line line = tree_line(segment->from, segment->direction);
    line.has_end = true;
    line.end = to_tree_vector(segment->to);
    line.e_end = tree_rounding(segment->to);
    struct sphere_walk walk = sphere_walk_begin(scene->tree, &line, (double)segment->length);
    for (int i; !(any && first != NO_SURFACE) && (i = sphere_walk_next(&walk)) != NO_MORE_SPHERES;)
        if ((first == NO_SURFACE || i < first) && sphere_blocks(scene, i, segment))
            first = i;
    return first;
}

/* The first surface, or any, that stands between the ends; NO_SURFACE: none does. */
static inline int find_blocker(const struct packed_scene *scene, const struct segment *segment, bool any)
{
    for (int i = 0; i < tried_spheres(scene); ++i)
        if (sphere_blocks(scene, i, segment))
            return i;
    const int in_tree = scene->tree ? find_blocker_in_tree(scene, segment, any) : NO_SURFACE;
    if (in_tree != NO_SURFACE)
        return in_tree;
    for (int i = 0; i < scene->plane_count; ++i)
        if (plane_blocks(&scene->planes[i], scene->sphere_count + i, segment))
            return scene->sphere_count + i;
    return NO_SURFACE;
}

static inline bool is_blocked(const struct packed_scene *scene, const struct segment *segment)
{
    return find_blocker(scene, segment, true) != NO_SURFACE;
}

#endif
