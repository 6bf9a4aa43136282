/* Running error analysis of the float tracer (Higham, "Accuracy and Stability of Numerical Algorithms",
 * section 3.3), carried along by the high-precision build: how far the float run may be from the exact one at
 * each quantity, to first order, and how far each decision is from going the other way. NUMERICS.md derives
 * the formulas. All errors are absolute and in scene units, radians or radiance. A margin is the distance to
 * the other outcome in units of the error: below 1, float may decide otherwise. It is never NaN. */
#ifndef REFERENCE_MARGIN_H
#define REFERENCE_MARGIN_H

#include "dielectric.h"
#include "geometry.h"

static const double unit_roundoff = 0x1p-24; /* float's */

/* What a few operations on quantities of this size lose: the vector formulas here take 4 to 8 roundings of
 * half a unit each. */
static inline double rounding(double magnitude)
{
    return 3 * unit_roundoff * magnitude;
}

static inline double length(struct vec3 v)
{
    return (double)square_root(dot(v, v));
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Of value > 0, value being known up to error; 0 where the analysis knows neither. */
static inline double margin_of(double value, double error)
{
    double margin = fabs(value) / error;
    return error == 0 ? INFINITY : margin >= 0 ? margin : 0;
}

/* How far the root of a square, 0 where that is negative, may be off, if the square may be by e_square. */
static inline double root_error(double square, double e_square)
{
    return square > e_square ? e_square / (sqrt(square) + sqrt(square - e_square)) : sqrt(e_square);
}

/* Of 1 / value, value > 0 being known up to error; huge where that may be 0. */
static inline double relative_error(double value, double error)
{
    return error < value ? error / (value - error) : 0x1p60;
}

struct ray_error {
    double origin;    /* length */
    double direction; /* radians */
};

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
    double e_clearance =
        error.origin + fabs((double)approach.along) * error.direction + rounding(apart + radius);
    return (struct tracked_approach){
        .along = (double)approach.along,
        .e_along = error.origin + apart * error.direction + rounding(apart),
        .clearance = (double)approach.half_chord_squared / (radius + center_offset),
        .e_clearance = e_clearance,
        .half_chord = sqrt(half_chord_squared),
        .e_half_chord = root_error(half_chord_squared, 2 * radius * e_clearance),
    };
}

/* How far float's `lies_inside` is from the other answer. */
static inline double inside_margin(layout_vec4 center_radius, struct vec3 point, double e_point)
{
    double apart = length(subtract(vector_of(center_radius), point)), radius = (double)center_radius.w;
    return margin_of(apart - radius, e_point + rounding(apart + radius));
}

static inline bool contains(const struct PackedSphere *sphere, struct vec3 point)
{
    return lies_inside(subtract(vector_of(sphere->center_radius), point), sphere->center_radius.w);
}

/* Error of a distance along the ray to the surface, which the ray meets; INFINITY where float may take the
 * ray to run along a plane. */
static inline double distance_error(const struct packed_scene *scene, const struct ray *ray, int surface,
                                    double distance, struct ray_error error)
{
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

/* Margin of a sphere's not being the nearest hit, which is at nearest_distance +- e_nearest. */
static inline double sphere_margin(const struct packed_scene *scene, int i, const struct ray *ray,
                                   struct ray_error error, double nearest_distance, double e_nearest)
{
    const struct PackedSphere *sphere = &scene->spheres[i];
    struct tracked_approach approach =
        track_approach(sphere->center_radius, ray->origin, ray->direction, error);
    if (ray->surface == i) /* certain to be met, at its far side, or certain not to be */
        return ray->inward
                   ? margin_of(nearest_distance - 2 * approach.along, e_nearest + 2 * approach.e_along)
                   : INFINITY;
    double margin = INFINITY;
    if (sphere->tags.HOLDS_RAYS != 0) {
        margin = inside_margin(sphere->center_radius, ray->origin, error.origin);
        if (contains(sphere, ray->origin)) /* likewise */
            return smaller(margin, margin_of(nearest_distance - approach.along - approach.half_chord,
                                             e_nearest + approach.e_along + approach.e_half_chord));
    }
    struct conjunction met = conjunction_begin();
    require_positive(&met, approach.along, approach.e_along);
    require_positive(&met, approach.clearance, approach.e_clearance);
    /* Met or not, it matters only where it is not clearly behind the nearest. */
    double front = approach.along - approach.half_chord;
    require_positive(&met, nearest_distance - front, e_nearest + approach.e_along + approach.e_half_chord);
    return smaller(margin, conjunction_margin(&met));
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
    line.e_origin += wanted * error.origin;
    line.e_direction += wanted * error.direction;
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

/* Errors of the hit's point and normal. */
struct hit_error {
    double point, normal;
};

static inline struct hit_error track_hit(const struct packed_scene *scene, const struct ray *ray,
                                         struct ray_error error, const struct hit *hit)
{
    double size = length(hit->point);
    if (hit->surface >= scene->sphere_count)
        return (struct hit_error){
            .point = distance_error(scene, ray, hit->surface, (double)hit->distance, error) + rounding(size),
        };
    layout_vec4 sphere = scene->spheres[hit->surface].center_radius;
    struct tracked_approach approach = track_approach(sphere, ray->origin, ray->direction, error);
    double radius = (double)sphere.w;
    double normal =
        approach.e_half_chord / radius + rounding(1); /* e_clearance / half_chord, or what it can be */
    return (struct hit_error){
        .normal = normal,
        .point = radius * normal + rounding(size + radius),
    };
}

/* What follows for reflection and refraction. */
struct dielectric_error {
    double refracted_direction, reflectance;
    double margin; /* of total reflection or not */
};

static inline double track_reflection(double e_direction, double e_normal)
{
    return e_direction + 2 * e_normal + rounding(2);
}

/* The most that is transmitted, if cos_out is at most this, and cos_in at least that. */
static inline double most_transmitted(double cos_in, double cos_out, double eta)
{
    return cos_in > 0 ? smaller(2 * (cos_out / cos_in) * (eta + 1 / eta), 1) : 1;
}

static inline struct dielectric_error track_refraction(double cos_in, double eta, double kappa,
                                                       double e_direction, double e_normal)
{
    double e_cos_in = e_direction + e_normal + rounding(1);
    double eta_cos = eta * cos_in;
    double squared = kappa + eta_cos * eta_cos;
    double e_squared = 2 * eta * eta_cos * e_cos_in + eta * eta * e_cos_in * e_cos_in +
                       rounding(fabs(kappa) + eta_cos * eta_cos);
    struct dielectric_error error = {.margin = margin_of(squared, e_squared)};
    double cos_out = sqrt(larger(squared, 0)), e_cos_out = root_error(squared, e_squared);
    if (error.margin < 1)
        error.reflectance = most_transmitted(cos_in - e_cos_in, cos_out + e_cos_out, eta);
    if (squared <= 0)
        return error;
    double sum = eta_cos + cos_out, e_sum = relative_error(sum, eta * e_cos_in + e_cos_out);
    double bend = fabs(kappa) / sum;
    double e_bend = bend * e_sum + rounding(bend);
    error.refracted_direction = eta * e_direction + e_bend + bend * e_normal + rounding(eta + bend);
    if (error.margin < 1)
        return error;

    double r_s = bend / sum, e_r_s = r_s * e_sum * (2 + e_sum) + rounding(r_s);
    double cosines = cos_in * cos_out, sines = eta * (1 - cos_in * cos_in);
    double e_cosines = cos_in * e_cos_out + cos_out * e_cos_in + rounding(cosines);
    double e_sines = 2 * eta_cos * e_cos_in + rounding(eta);
    double ratio = fabs(cosines - sines) / (cosines + sines);
    double e_ratio = (e_cosines + e_sines) * (1 + ratio) / (cosines + sines) + rounding(ratio);
    error.reflectance = r_s * e_r_s * (1 + ratio * ratio) +
                        r_s * r_s * (ratio * e_ratio + e_ratio * e_ratio) + rounding(r_s * r_s);
    return error;
}

#endif
