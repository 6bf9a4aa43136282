/* Running error analysis of the float tracer (Higham, "Accuracy and Stability of Numerical Algorithms",
 * section 3.3), carried along by the high-precision build: how far the float run may be from the exact one in
 * each quantity, to first order, as long as it decides as the exact one does. NUMERICS.md derives the
 * formulas. All errors are absolute and in scene units, radians or radiance. */
#ifndef REFERENCE_ERROR_H
#define REFERENCE_ERROR_H

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

/* Of a vector: of its components, and of all of it. Components are sharp where a vector lies near an axis,
 * the length where it is turned again and again. */
struct errors {
    double x, y, z, length;
};

static const struct errors no_errors = {0, 0, 0, 0}; /* of what is exact */

/* Of a number that is off by error, times v. */
static inline struct errors errors_along(struct vec3 v, double error)
{
    return (struct errors){error * fabs((double)v.x), error * fabs((double)v.y), error * fabs((double)v.z),
                           error * length(v)};
}

/* That many roundings of each component. */
static inline struct errors errors_of(double roundings, struct vec3 v)
{
    return errors_along(v, roundings * unit_roundoff);
}

static inline struct errors errors_add(struct errors a, struct errors b)
{
    return (struct errors){a.x + b.x, a.y + b.y, a.z + b.z, a.length + b.length};
}

static inline struct errors errors_scale(double factor, struct errors e)
{
    factor = fabs(factor);
    return (struct errors){factor * e.x, factor * e.y, factor * e.z, factor * e.length};
}

static inline struct vec3 errors_vector(struct errors e)
{
    return (struct vec3){(real)e.x, (real)e.y, (real)e.z};
}

static inline double errors_length(struct errors e)
{
    return smaller(sqrt(e.x * e.x + e.y * e.y + e.z * e.z), e.length);
}

/* Of a length, of a vector that is off by `off`: half of a dot product's roundings, and the root's. */
static inline double length_error(double length_of_it, double off)
{
    return off + 2.5 * unit_roundoff * length_of_it;
}

/* What they bring into a product with v. */
static inline double errors_weigh(struct vec3 v, struct errors e)
{
    return smaller(fabs((double)v.x) * e.x + fabs((double)v.y) * e.y + fabs((double)v.z) * e.z,
                   length(v) * e.length);
}

/* Of a product: three roundings of each term. */
static inline double dot_error(struct vec3 a, struct errors e_a, struct vec3 b, struct errors e_b)
{
    return errors_weigh(a, e_b) + errors_weigh(b, e_a) + errors_weigh(a, errors_of(3, b));
}

/* Of factor x - p (q . x), which is no longer than norm |x|, x having the errors e. */
static inline struct errors errors_through(double norm, double factor, struct vec3 p, struct vec3 q,
                                           struct errors e)
{
    const double px = (double)p.x, py = (double)p.y, pz = (double)p.z;
    const double qx = (double)q.x, qy = (double)q.y, qz = (double)q.z;
    const double x = fabs(qx) * e.x, y = fabs(qy) * e.y, z = fabs(qz) * e.z;
    const double most = norm * errors_length(e);
    return (struct errors){smaller(fabs(factor - px * qx) * e.x + fabs(px) * (y + z), most),
                           smaller(fabs(factor - py * qy) * e.y + fabs(py) * (x + z), most),
                           smaller(fabs(factor - pz * qz) * e.z + fabs(pz) * (x + y), most), most};
}

/* What the length of a unit vector may be off by: normalize()'s roundings, and more than renormalize()'s. */
static const double length_roundings = 4.5;

/* Of v once it has been put to length 1, which v is but for such errors. */
static inline struct errors unit_errors(struct vec3 v, struct errors e)
{
    return errors_add(errors_through(1, 1, v, v, e), errors_of(length_roundings, v));
}

struct ray_errors {
    struct errors origin, direction;
};

/* Of a primary ray: the sum of forward and two multiples of half pixels, made unit. */
static inline struct ray_errors track_primary(const struct packed_scene *scene, struct vec3 direction)
{
    const struct vec3 forward = vector_of(scene->view.forward);
    const struct vec3 beside = subtract(scale(1 / dot(forward, direction), direction), forward);
    const struct vec3 sides[] = {vector_of(scene->view.half_pixel_right),
                                 vector_of(scene->view.half_pixel_down)};
    struct errors sum = errors_of(2, forward);
    for (int i = 0; i < 2; ++i)
        if (dot(sides[i], sides[i]) > 0)
            sum = errors_add(sum,
                             errors_of(4, scale(dot(beside, sides[i]) / dot(sides[i], sides[i]), sides[i])));
    return (struct ray_errors){
        .direction = unit_errors(direction, errors_scale((double)dot(forward, direction), sum))};
}

struct hit_error {
    struct errors point, normal;
    double distance;
};

/* Where the ray, off by `moved` there, meets a surface with that normal: along its direction until it does.
 */
static inline struct errors meeting_error(const struct ray *ray, struct vec3 normal, struct errors moved)
{
    const real slope = dot(normal, ray->direction);
    return errors_through(1 / fabs((double)slope), 1, scale(1 / slope, ray->direction), normal, moved);
}

static inline struct errors moved_errors(const struct ray_errors *error, double distance)
{
    return errors_add(error->origin, errors_scale(distance, error->direction));
}

static inline struct hit_error track_sphere_hit(layout_vec4 sphere, const struct ray *ray,
                                                const struct ray_errors *error, const struct hit *hit)
{
    const struct vec3 to_center = subtract(vector_of(sphere), ray->origin), direction = ray->direction;
    const struct approach approach = approach_sphere(to_center, direction, sphere.w);
    const double radius = (double)sphere.w;
    const double half_chord_squared = (double)at_least_zero(approach.half_chord_squared),
                 half_chord = sqrt(half_chord_squared);
    const struct vec3 across = approach.center_offset;
    const struct errors e_across =
        errors_add(errors_of(1, scale(approach.along, direction)), errors_of(1, across));
    /* a direction's length counts twice, in the product and times it */
    const double e_along = errors_weigh(to_center, errors_of(3, direction)) +
                           2 * length_roundings * unit_roundoff * fabs((double)approach.along);
    const double e_half_chord =
        (errors_weigh(across, e_across) + e_along * e_along + 2 * unit_roundoff * radius * radius) /
            half_chord +
        unit_roundoff * half_chord;
    const double e_forward = e_along + e_half_chord + (1 + length_roundings) * unit_roundoff * half_chord;
    struct errors rounded = errors_add(e_across, errors_along(direction, e_forward));
    rounded = errors_add(rounded, errors_of(radius, hit->normal));
    const struct errors moved =
        errors_add(moved_errors(error, (double)hit->distance), errors_of(1, to_center));
    /* that the line is off by counts as 1 / half_chord, which changes on the way */
    const double e_square = 2 * radius * (errors_length(moved) + errors_length(rounded));
    const double cos = fabs((double)dot(hit->normal, direction));
    const double stretch = root_error(half_chord_squared, e_square) * 2 * half_chord / e_square;
    const struct errors sum =
        errors_add(errors_through(1, 1, hit->normal, hit->normal, rounded),
                   errors_scale(larger(stretch, 1), meeting_error(ray, hit->normal, moved)));
    const struct errors normal =
        errors_add(errors_scale(1 / radius, sum), errors_of(length_roundings, hit->normal));
    return (struct hit_error){
        .normal = normal,
        .distance = larger(stretch, 1) * errors_weigh(hit->normal, moved) / cos + e_along + e_half_chord,
        .point = errors_add(errors_scale(radius, normal),
                            errors_add(errors_of(radius, hit->normal), errors_of(1, hit->point))),
    };
}

static inline struct hit_error track_plane_hit(layout_vec4 plane, const struct ray *ray,
                                               const struct ray_errors *error, const struct hit *hit)
{
    const struct vec3 normal = vector_of(plane), direction = ray->direction;
    const real slope = dot(normal, direction);
    const double size = fabs((double)slope), distance = (double)hit->distance;
    const double e_slope = dot_error(normal, no_errors, direction, error->direction);
    const double e_distance = (errors_weigh(normal, errors_of(3, ray->origin)) +
                               distance * dot_error(normal, no_errors, direction, no_errors)) /
                                  size +
                              2 * unit_roundoff * distance;
    const double grown = 1 + relative_error(size, e_slope);
    const struct errors moved = moved_errors(error, distance);
    /* What rounding moves the point along the normal is taken back, but for the residual's and the last. */
    const struct errors rounded = errors_add(errors_of(distance, direction), errors_of(1, hit->point));
    struct errors point = errors_add(meeting_error(ray, normal, moved),
                                     errors_along(subtract(direction, scale(slope, normal)), e_distance));
    point = errors_add(errors_scale(grown, point), errors_through(1, 1, normal, normal, rounded));
    const struct errors off = errors_scale(
        4 * unit_roundoff, errors_add(rounded, errors_along(direction, e_distance))); /* roundings of those */
    const double e_residual = errors_weigh(normal, errors_add(errors_of(3, hit->point), off));
    point = errors_add(point, errors_add(off, errors_along(normal, e_residual)));
    return (struct hit_error){
        .distance = grown * errors_weigh(normal, moved) / size + e_distance,
        .point = errors_add(point, errors_of(1, hit->point)),
    };
}

/* What rounding makes of the height of a point: five roundings of each term and
 * one of the difference. */
static inline double height_rounding(const struct giant *giant, struct vec3 point)
{
    const struct vec3 bend = scale(giant->curvature / 2, point);
    return errors_weigh(point, errors_add(errors_of(6, giant->gradient), errors_of(6, bend))) +
           unit_roundoff * fabs((double)giant->offset);
}

static inline struct hit_error track_giant_hit(const struct giant *giant, const struct ray *ray,
                                               const struct ray_errors *error, const struct hit *hit)
{
    const struct vec3 normal = hit->normal, direction = ray->direction, origin = ray->origin;
    const struct vec3 bend = scale(giant->curvature, origin);
    const struct giant_line line = giant_line(giant, origin, direction, true);
    const double curvature = (double)giant->curvature, distance = (double)hit->distance;
    const double slope = fabs((double)line.slope), root = fabs((double)dot(normal, direction));
    const double e_slope = errors_weigh(giant_gradient(giant, origin), error->direction) +
                           curvature * errors_weigh(direction, error->origin);
    const double r_slope =
        errors_weigh(direction, errors_add(errors_of(5, giant->gradient), errors_of(5, bend)));
    const struct errors moved = moved_errors(error, distance);
    struct errors point;
    double e_distance, r_distance;
    if (ray->surface == hit->surface) { /* a chord */
        r_distance = 2 * r_slope / curvature + 2 * (1 + length_roundings) * unit_roundoff * distance;
        e_distance = 2 * e_slope / curvature;
        point =
            errors_add(errors_through(1, 1, normal, normal, moved),
                       errors_along(subtract(direction, scale(dot(normal, direction), normal)), e_distance));
    } else {
        /* with what a direction's length, taken to be 1, may be off by */
        const double r_height = height_rounding(giant, origin) + distance * r_slope +
                                length_roundings * unit_roundoff * curvature * distance * distance;
        const double r_root =
            unit_roundoff * ((slope * slope + 2 * curvature * fabs((double)line.height)) / root + root);
        /* the slope at the surface, by which heights are divided, changes on the way */
        const double steep = larger(root - e_slope - r_slope, root / 2);
        const double off = errors_weigh(normal, moved) + r_height;
        const double stretch = 2 * root / (steep + sqrt(larger(steep * steep - 2 * curvature * off, 0)));
        r_distance = stretch * r_height / root + distance * (r_root / (slope + root) + 3 * unit_roundoff);
        e_distance = stretch * errors_weigh(normal, moved) / root;
        point = errors_scale(stretch, meeting_error(ray, normal, moved));
    }
    const struct errors rounded = errors_add(errors_of(distance, direction), errors_of(1, hit->point));
    const struct errors turned =
        errors_scale(curvature, errors_add(moved, errors_along(direction, e_distance + r_distance)));
    point = errors_add(point,
                       errors_along(subtract(direction, scale(dot(normal, direction), normal)), r_distance));
    point = errors_add(point, errors_through(1, 1, normal, normal, rounded));
    point = errors_add(point, errors_along(normal, height_rounding(giant, hit->point)));
    return (struct hit_error){
        .normal = unit_errors(
            normal, errors_add(turned, errors_add(errors_of(1, normal),
                                                  errors_of(1, scale(giant->curvature, hit->point))))),
        .distance = e_distance + r_distance,
        .point = errors_add(point, errors_of(1, hit->point)),
    };
}

static inline struct hit_error track_hit(const struct packed_scene *scene, const struct ray *ray,
                                         const struct ray_errors *error, const struct hit *hit)
{
    if (is_giant(scene, hit->surface)) {
        const struct giant giant = giant_of(scene, hit->surface);
        return track_giant_hit(&giant, ray, error, hit);
    }
    if (hit->surface < scene->sphere_count)
        return track_sphere_hit(scene->spheres[hit->surface].center_radius, ray, error, hit);
    return track_plane_hit(scene->planes[hit->surface - scene->sphere_count].normal_offset, ray, error, hit);
}

static inline struct errors track_reflection(struct vec3 direction, struct errors e_direction,
                                             struct vec3 normal, struct errors e_normal)
{
    const struct vec3 twice = scale(2, normal);
    const real cos_in = -dot(normal, direction);
    const struct vec3 reflected = add(direction, scale(cos_in, twice));
    struct errors sum =
        errors_add(errors_through(1, 1, twice, normal, e_direction),
                   errors_through(2 + 2 * (double)cos_in, 2 * (double)cos_in, twice, direction, e_normal));
    sum = errors_add(sum, errors_along(twice, dot_error(normal, no_errors, direction, no_errors) +
                                                  unit_roundoff * fabs((double)cos_in)));
    return unit_errors(reflected, errors_add(sum, errors_of(1, reflected)));
}

/* Of what glass does to a ray. */
struct dielectric_error {
    double cos_in, reflectance;
    double cos_out_squared, of_cos_out_squared; /* with its error: total reflection or not */
    struct errors refracted;                    /* direction */
};

/* The most that is transmitted, if cos_out is at most this, and cos_in at least that. */
static inline double most_transmitted(double cos_in, double cos_out, double eta)
{
    return cos_in > 0 ? smaller(2 * (cos_out / cos_in) * (eta + 1 / eta), 1) : 1;
}

static inline double track_reflectance(double cos_in, double e_cos_in, double cos_out, double e_cos_out,
                                       double eta, double bend, double e_sum)
{
    const double r_s = bend / (eta * cos_in + cos_out);
    const double e_r_s = r_s * (e_sum * (2 + e_sum) + 6 * unit_roundoff);
    const double cosines = cos_in * cos_out, sines = fabs(eta * (1 - cos_in * cos_in)),
                 both = cosines + sines;
    const double e_cosines = cos_in * e_cos_out + cos_out * e_cos_in + 2 * unit_roundoff * cosines;
    const double e_sines = 2 * eta * cos_in * e_cos_in + 3 * unit_roundoff * eta;
    const double ratio = fabs(cosines - sines) / both;
    const double grown = 1 + relative_error(both, e_cosines + e_sines);
    const double e_ratio = 2 * (sines * e_cosines + cosines * e_sines) / (both * both) * (grown * grown) +
                           3 * unit_roundoff * ratio;
    return (r_s * e_r_s + e_r_s * e_r_s / 2) * (1 + ratio * ratio) +
           r_s * r_s * (ratio * e_ratio + e_ratio * e_ratio / 2) + 4 * unit_roundoff * r_s * r_s;
}

static inline struct dielectric_error track_refraction(struct vec3 direction, struct errors e_direction,
                                                       struct vec3 normal, struct errors e_normal,
                                                       struct vec3 refracted, double eta, double kappa)
{
    const double cos_in = (double)at_least_zero(-dot(normal, direction));
    const double e_cos_in = dot_error(normal, e_normal, direction, e_direction), e_eta_cos = eta * e_cos_in;
    const double eta_cos = eta * cos_in, squared = kappa + eta_cos * eta_cos;
    const double e_squared =
        (2 * eta_cos + e_eta_cos) * e_eta_cos + unit_roundoff * (3 * eta_cos * eta_cos + fabs(squared));
    struct dielectric_error error = {
        .cos_in = e_cos_in, .cos_out_squared = squared, .of_cos_out_squared = e_squared};
    const double cos_out = sqrt(larger(squared, 0)),
                 e_cos_out = root_error(squared, e_squared) + unit_roundoff * cos_out;
    error.reflectance = most_transmitted(cos_in - e_cos_in, cos_out + e_cos_out, eta);
    if (squared <= 0)
        return error;
    const double sum = eta_cos + cos_out, e_sum = relative_error(sum, e_eta_cos + e_cos_out);
    const double bend = fabs(kappa) / sum, e_bend = bend * (e_sum + 3 * unit_roundoff);
    struct errors errors = errors_add(errors_scale(eta, errors_add(e_direction, errors_of(1, direction))),
                                      errors_scale(bend, errors_add(e_normal, errors_of(1, normal))));
    errors = errors_add(errors, errors_add(errors_along(normal, e_bend), errors_of(1, refracted)));
    error.refracted = unit_errors(refracted, errors);
    if (fabs(squared) > e_squared)
        error.reflectance = track_reflectance(cos_in, e_cos_in, cos_out, e_cos_out, eta, bend, e_sum);
    return error;
}

#endif
