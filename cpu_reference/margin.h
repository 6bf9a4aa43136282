/* How far each decision of the float tracer is from going the other way, as the high-precision build finds
 * it; see error.h. A margin is the distance to the other outcome in units of the error: below 1, float may
 * decide otherwise. It is never NaN. */
#ifndef REFERENCE_MARGIN_H
#define REFERENCE_MARGIN_H

#include "error.h"

/* Of value > 0 or not, value being known up to error; 0 where the analysis knows neither. */
static inline double margin_of(double value, double error)
{
    double margin = fabs(value) / error;
    return error == 0 ? INFINITY : margin >= 0 ? margin : 0;
}

/* A decision by several conditions that must all hold: if it holds, the weakest condition decides how safe it
 * is; if not, the strongest of those that fail. */
struct conjunction {
    bool holds;
    double weakest, strongest_failure;
};

static inline struct conjunction conjunction_begin(void)
{
    return (struct conjunction){.holds = true, .weakest = INFINITY, .strongest_failure = 0};
}

/* value > 0, value being known up to error. */
static inline void require_positive(struct conjunction *decision, double value, double error)
{
    double margin = margin_of(value, error);
    if (value > 0) {
        decision->weakest = smaller(decision->weakest, margin);
    } else {
        decision->holds = false;
        decision->strongest_failure = larger(decision->strongest_failure, margin);
    }
}

static inline double conjunction_margin(const struct conjunction *decision)
{
    return decision->holds ? decision->weakest : decision->strongest_failure;
}

/* How far a ray may be off. */
struct ray_error {
    double origin;    /* length */
    double direction; /* radians */
};

/* How a ray passes a sphere, with errors. */
struct tracked_approach {
    double along, e_along;
    double clearance, e_clearance; /* radius - distance of the line from the centre */
    double half_chord, e_half_chord;
};

static inline struct tracked_approach track_approach(layout_vec4 center_radius, struct vec3 origin,
                                                     struct vec3 direction, struct ray_error error)
{
    struct vec3 to_center = subtract(vector_of(center_radius), origin);
    struct approach approach = approach_sphere(to_center, direction, center_radius.w);
    double apart = length(to_center), radius = (double)center_radius.w;
    double center_offset = length(approach.center_offset);
    double half_chord_squared = (double)at_least_zero(approach.half_chord_squared);
    /* The line's distance from the centre is apart * sin(angle). Turned by d it changes by at most
     * apart * (|cos(angle)| d + d^2 / 2); at a right angle the square is all there is. */
    double e_clearance =
        error.origin +
        (fabs((double)approach.along) + error.origin + apart * error.direction / 2) * error.direction +
        rounding(apart + radius);
    return (struct tracked_approach){
        .along = (double)approach.along,
        .e_along = error.origin + apart * error.direction + rounding(apart),
        .clearance = (double)approach.half_chord_squared / (radius + center_offset),
        .e_clearance = e_clearance,
        .half_chord = sqrt(half_chord_squared),
        .e_half_chord = root_error(half_chord_squared, 2 * radius * e_clearance),
    };
}

/* Of a height over a giant; no gradient on the way to the point is longer than `steepest`. */
static inline double height_error(const struct giant *giant, struct vec3 point, double e_point)
{
    double steepest = length(giant->gradient) + (double)giant->curvature * length(point);
    return e_point * steepest + rounding(fabs((double)giant->offset) + length(point) * steepest);
}

/* How far float's lies_inside() is from the other answer. */
static inline double inside_margin(const struct packed_scene *scene, int i, struct vec3 point, double e_point)
{
    if (is_giant(scene, i)) {
        struct giant giant = giant_of(scene, i);
        return margin_of((double)giant_height(&giant, point), height_error(&giant, point, e_point));
    }
    layout_vec4 sphere = scene->spheres[i].center_radius;
    double apart = length(subtract(vector_of(sphere), point)), radius = (double)sphere.w;
    return margin_of(apart - radius, e_point + rounding(apart + radius));
}

/* As giant_line(), with errors. */
struct tracked_giant_line {
    double height, e_height, slope, e_slope;
    double root_squared, e_root_squared;
    double root, e_root;
};

static inline struct tracked_giant_line track_giant_line(const struct giant *giant, struct vec3 origin,
                                                         struct vec3 direction, struct ray_error error,
                                                         bool may_be_inside)
{
    struct giant_line line = giant_line(giant, origin, direction, may_be_inside);
    double curvature = (double)giant->curvature;
    double steepest = length(giant->gradient) + curvature * length(origin);
    struct tracked_giant_line tracked = {
        .height = (double)line.height,
        .e_height = height_error(giant, origin, error.origin),
        .slope = (double)line.slope,
        .e_slope = error.direction * steepest + curvature * error.origin + rounding(steepest),
        .root_squared = (double)line.root_squared,
        .root = (double)giant_root(&line),
    };
    tracked.e_root_squared = (2 * fabs(tracked.slope) + tracked.e_slope) * tracked.e_slope +
                             2 * curvature * tracked.e_height +
                             rounding(tracked.slope * tracked.slope + 2 * curvature * fabs(tracked.height));
    tracked.e_root = root_error(tracked.root * tracked.root, tracked.e_root_squared);
    return tracked;
}

/* Error of the distance at which the line meets the giant: a chord; from inside; or from outside, where it is
 * 2 height / (root - slope). Where the line is certain to meet it, e_slope + e_root is at most 3/4 of that.
 */
static inline double giant_distance_error(const struct giant *giant, const struct tracked_giant_line *line,
                                          bool chord, double distance)
{
    double curvature = (double)giant->curvature, e_divisor = line->e_slope + line->e_root;
    double divisor = fabs(line->slope) + line->root;
    if (chord)
        return 2 * line->e_slope / curvature + rounding(distance);
    if (line->height < 0 && line->slope <= 0)
        return e_divisor / curvature + rounding(distance);
    return (2 * line->e_height + distance * e_divisor) / larger(divisor - e_divisor, divisor / 4) +
           rounding(distance);
}

/* Error of a distance along the ray to the surface, which the ray meets; INFINITY where float may take the
 * ray to run along a plane. */
static inline double distance_error(const struct packed_scene *scene, const struct ray *ray, int surface,
                                    double distance, struct ray_error error)
{
    if (is_giant(scene, surface)) {
        struct giant giant = giant_of(scene, surface);
        struct tracked_giant_line line = track_giant_line(&giant, ray->origin, ray->direction, error, true);
        return giant_distance_error(&giant, &line, ray->surface == surface, distance);
    }
    if (surface < scene->sphere_count) {
        struct tracked_approach approach =
            track_approach(scene->spheres[surface].center_radius, ray->origin, ray->direction, error);
        return approach.e_along + (ray->surface == surface ? approach.e_along : approach.e_half_chord);
    }
    layout_vec4 plane = scene->planes[surface - scene->sphere_count].normal_offset;
    double slope = fabs((double)dot(vector_of(plane), ray->direction)) - error.direction - rounding(1);
    double size = length(ray->origin) + fabs((double)plane.w) + distance;
    return slope > 0 ? (error.origin + distance * error.direction + rounding(size)) / slope : INFINITY;
}

/* Margin of the far side of sphere i, which is certain to be met, not being the nearest hit. */
static inline double far_side_margin(const struct packed_scene *scene, int i, const struct ray *ray,
                                     struct ray_error error, double nearest_distance, double e_nearest)
{
    if (is_giant(scene, i)) {
        real distance;
        bool from_inside;
        meet_sphere(scene, i, ray, &distance, &from_inside);
        return margin_of(nearest_distance - (double)distance,
                         e_nearest + distance_error(scene, ray, i, (double)distance, error));
    }
    struct tracked_approach approach =
        track_approach(scene->spheres[i].center_radius, ray->origin, ray->direction, error);
    if (ray->surface == i)
        return margin_of(nearest_distance - 2 * approach.along, e_nearest + 2 * approach.e_along);
    return margin_of(nearest_distance - approach.along - approach.half_chord,
                     e_nearest + approach.e_along + approach.e_half_chord);
}

/* Margin of a sphere's not being the nearest hit, which is at nearest_distance +- e_nearest. */
static inline double sphere_margin(const struct packed_scene *scene, int i, const struct ray *ray,
                                   struct ray_error error, double nearest_distance, double e_nearest)
{
    const bool own = ray->surface == i, holds_rays = !own && scene->spheres[i].tags.HOLDS_RAYS != 0;
    if (own && !ray->inward) /* certain not to be met */
        return INFINITY;
    double margin = holds_rays ? inside_margin(scene, i, ray->origin, error.origin) : INFINITY;
    if (own || (holds_rays && lies_inside(scene, i, ray->origin)))
        return smaller(margin, far_side_margin(scene, i, ray, error, nearest_distance, e_nearest));
    /* Met or not, it matters only where it is not clearly behind the nearest. */
    struct conjunction before = conjunction_begin();
    if (is_giant(scene, i)) {
        struct giant giant = giant_of(scene, i);
        struct tracked_giant_line line =
            track_giant_line(&giant, ray->origin, ray->direction, error, holds_rays);
        require_positive(&before, -line.slope, line.e_slope);
        require_positive(&before, line.root_squared, line.e_root_squared);
        /* as for planes: 2 height / divisor < nearest_distance */
        double divisor = line.root - line.slope, e_divisor = line.e_slope + line.e_root;
        require_positive(&before, nearest_distance * divisor - 2 * line.height,
                         2 * line.e_height + nearest_distance * e_divisor + e_nearest * fabs(divisor));
    } else {
        struct tracked_approach approach =
            track_approach(scene->spheres[i].center_radius, ray->origin, ray->direction, error);
        require_positive(&before, approach.along, approach.e_along);
        require_positive(&before, approach.clearance, approach.e_clearance);
        double front = approach.along - approach.half_chord;
        require_positive(&before, nearest_distance - front,
                         e_nearest + approach.e_along + approach.e_half_chord);
    }
    return smaller(margin, conjunction_margin(&before));
}

/* Whether the ray meets the side of a plane on which its height is positive, before the nearest distance. */
static inline struct conjunction side_met(const struct PackedPlane *plane, double slope, double e_slope,
                                          double height, double e_height, double nearest_distance,
                                          double e_nearest)
{
    struct conjunction met = conjunction_begin();
    require_positive(&met, -slope, e_slope);
    if (plane->surface.tags.SURFACE_KIND == KIND_TRANSPARENT)
        require_positive(&met, height, e_height); /* of opaque planes known */
    /* height / -slope < nearest_distance, without dividing by a slope near 0 */
    require_positive(&met, nearest_distance * -slope - height,
                     e_height + nearest_distance * e_slope + e_nearest * fabs(slope));
    return met;
}

static inline double plane_margin(const struct packed_scene *scene, int i, const struct ray *ray,
                                  struct ray_error error, double nearest_distance, double e_nearest)
{
    const struct PackedPlane *plane = &scene->planes[i];
    if (ray->surface == scene->sphere_count + i)
        return INFINITY;
    struct vec3 normal = vector_of(plane->normal_offset);
    double slope = (double)dot(normal, ray->direction);
    double height = (double)(dot(normal, ray->origin) - plane->normal_offset.w);
    double e_slope = error.direction + rounding(1);
    double e_height = error.origin + rounding(length(ray->origin) + fabs((double)plane->normal_offset.w));
    bool opaque = plane->surface.tags.SURFACE_KIND != KIND_TRANSPARENT;
    struct conjunction front = side_met(plane, slope, e_slope, opaque ? larger(height, 0) : height, e_height,
                                        nearest_distance, e_nearest);
    if (opaque || front.holds)
        return conjunction_margin(&front);
    struct conjunction back =
        side_met(plane, -slope, e_slope, -height, e_height, nearest_distance, e_nearest);
    return back.holds ? back.weakest : smaller(front.strongest_failure, back.strongest_failure);
}

/* As tree_line(), of what float makes of the line: the tree rules out what has a margin of `wanted` at least,
 * which is at most 1. */
static inline struct tree_line tree_line_in_float(struct vec3 origin, struct vec3 direction,
                                                  struct ray_error error, double wanted)
{
    struct tree_line line = tree_line(origin, direction);
    if (!(wanted > 0)) /* however large the errors are */
        return line;
    line.e_origin += wanted * error.origin * (1 + error.direction); /* as in track_approach() */
    line.e_direction += wanted * error.direction * (1 + error.direction / 2);
    line.unit += wanted * unit_roundoff;
    return line;
}

/* Margin of sphere i's being the nearest hit, which is at distance +- e_distance, or not. */
static inline double choice_margin(const struct packed_scene *scene, int i, const struct ray *ray,
                                   struct ray_error error, const struct hit *hit, double distance,
                                   double e_distance)
{
    if (i == hit->surface) /* only whether it is met at all */
        return sphere_margin(scene, i, ray, error, FARTHEST_HIT, 0);
    return sphere_margin(scene, i, ray, error, distance, e_distance);
}

/* The least of those that the tree does not rule out, which looks ever closer as smaller ones are found. */
static inline double tree_margin(const struct packed_scene *scene, const struct ray *ray,
                                 struct ray_error error, const struct hit *hit, double distance,
                                 double e_distance, double wanted)
{
    const struct tree_line line = tree_line_in_float(ray->origin, ray->direction, error, wanted);
    struct sphere_walk walk = sphere_walk_begin(scene->tree, &line, distance + e_distance);
    double margin = INFINITY;
    for (int i; margin != 0 && (i = sphere_walk_next(&walk)) != NO_MORE_SPHERES;) {
        margin = smaller(margin, choice_margin(scene, i, ray, error, hit, distance, e_distance));
        if (margin < wanted) {
            wanted = margin;
            walk.line = tree_line_in_float(ray->origin, ray->direction, error, wanted);
        }
    }
    return margin;
}

/* Margin of the choice of the nearest hit (or of none). One of at least 1 may be larger with a tree. */
static inline double hit_margin(const struct packed_scene *scene, const struct ray *ray,
                                struct ray_error error, const struct hit *hit)
{
    bool none = hit->surface == NO_SURFACE;
    double distance = none ? FARTHEST_HIT : (double)hit->distance;
    double e_distance = none ? 0 : distance_error(scene, ray, hit->surface, distance, error);
    double margin = INFINITY;
    for (int i = 0; i < tried_spheres(scene); ++i)
        margin = smaller(margin, choice_margin(scene, i, ray, error, hit, distance, e_distance));
    if (scene->tree)
        margin =
            smaller(margin, tree_margin(scene, ray, error, hit, distance, e_distance, smaller(margin, 1)));
    for (int i = 0; i < scene->plane_count; ++i) {
        bool nearest = scene->sphere_count + i == hit->surface;
        margin = smaller(margin, plane_margin(scene, i, ray, error, nearest ? FARTHEST_HIT : distance,
                                              nearest ? 0 : e_distance));
    }
    return margin;
}

#endif
