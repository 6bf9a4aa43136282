/* The reference at high precision, with a running error analysis of what the float tracer does: for each
 * pixel the radiance, the path signature, how far the nearest decision is from going the other way in float,
 * and a bound on float's error. Built at double and binary128 with the entry's name REFERENCE_EXPLAIN. */
#include "camera.h"
#include "events.h"
#include "light_margin.h"
#include "reference.h"

struct pixel {
    const struct packed_scene *scene;
    uint32_t seed, sample;
    struct vec3 radiance, error;
    double margin, widest;      /* widest: the largest of what the error is the sum of */
    enum reference_cause cause; /* of that */
    struct tally tally;
};

struct tracked_path {
    struct ray ray;
    struct ray_errors error;
    double weight, e_weight;
    bool followed; /* float has decided as here on the way. Where it may not have, the errors mean nothing,
                    * and the pixel's has all that the path may bring. */
    int bounces;
    uint32_t branch; /* of the ray tree, as in tracer.c */
};

/* An angle of which first-order errors tell little. */
static const double unknown_angle = 0.25;

static struct vec3 at_most(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

/* What rays of that weight may bring, exactly or in float, and so the most that they can differ by. */
static struct vec3 most_radiance(const struct pixel *pixel, double weight)
{
    return each(weight * (double)pixel->scene->view.truncation.RADIANCE_BOUND);
}

static void widen(struct pixel *pixel, struct vec3 error, enum reference_cause cause)
{
    double largest = larger((double)error.x, larger((double)error.y, (double)error.z));
    pixel->error = add(pixel->error, error);
    if (largest > pixel->widest) {
        pixel->widest = largest;
        pixel->cause = cause;
    }
}

/* Notes a decision, after which float may not follow the path. */
static void decide(struct pixel *pixel, struct tracked_path *path, double margin, enum reference_cause cause)
{
    if (!path->followed)
        return;
    pixel->margin = smaller(pixel->margin, margin);
    if (margin >= 1)
        return;
    if (pixel->scene->view.truncation.RADIANCE_BOUND >= (float)UNBOUNDED)
        cause = CAUSE_UNKNOWN;
    widen(pixel, most_radiance(pixel, path->weight + path->e_weight), cause);
    path->followed = false;
}

static void trace(struct pixel *pixel, struct tracked_path path);

static void trace_secondary(struct pixel *pixel, struct tracked_path path)
{
    decide(pixel, &path, margin_of(path.weight - SMALLEST_WEIGHT, path.e_weight), CAUSE_ROUNDING);
    if (path.weight > SMALLEST_WEIGHT)
        trace(pixel, path);
}

/* Adds what the path sees; radiance may be off by those errors for the two causes. */
static void gather(struct pixel *pixel, const struct tracked_path *path, struct vec3 radiance,
                   struct vec3 rounding_error, struct vec3 shadow_error)
{
    struct vec3 most = most_radiance(pixel, path->weight + path->e_weight);
    struct vec3 relative = scale((real)(path->e_weight + rounding(path->weight)), radiance);
    struct vec3 rounded = at_most(add(scale((real)path->weight, rounding_error), relative), most);
    struct vec3 shadow = at_most(scale((real)(path->weight + path->e_weight), shadow_error), most);
    TELL(record_leaf(radiance, scale((real)path->weight, radiance)));
    TELL(record_bounds(path->followed, add(rounding_error, shadow_error), add(rounded, shadow), 0, INFINITY));
    pixel->radiance = add(pixel->radiance, scale((real)path->weight, radiance));
    if (path->followed) {
        widen(pixel, rounded, CAUSE_ROUNDING);
        widen(pixel, shadow, CAUSE_SHADOW);
    }
}

static void gather_matte(struct pixel *pixel, const struct tracked_path *path, const struct hit *hit,
                         struct hit_error hit_error)
{
    const struct packed_scene *scene = pixel->scene;
    const uint32_t seed = hash32(pixel->seed + path->branch * (uint32_t)scene->quad_light_count);
    const struct vec3 none = {0, 0, 0}, albedo = vector_of(hit->material->parameters);
    if (!path->followed) {
        gather(pixel, path, reflect_lights(scene, &path->ray, hit, seed, pixel->sample, &pixel->tally), none,
               none);
        return;
    }
    const struct point_errors point = {hit_error, path->error.direction};
    struct tracked_light light =
        track_lights(scene, &path->ray, hit, &point, seed, pixel->sample, &pixel->tally);
    pixel->margin = smaller(pixel->margin, light.margin);
    gather(pixel, path, multiply(albedo, light.radiance), multiply(albedo, light.rounding),
           multiply(albedo, light.shadow));
}

/* The error of the weight of a branch of the path, of what it is computed from, or the most that it can be.
 */
static double branch_error(const struct tracked_path *path, double weight, double error)
{
    return smaller(error, larger(path->weight + path->e_weight - weight, weight));
}

static void trace_dielectric(struct pixel *pixel, const struct tracked_path *path, const struct hit *hit,
                             struct hit_error hit_error, struct tracked_path reflected)
{
    layout_vec4 glass = hit->material->parameters;
    real eta = hit->from_inside ? glass.ETA_EXITING : glass.ETA_ENTERING,
         kappa = hit->from_inside ? glass.KAPPA_EXITING : glass.KAPPA_ENTERING;
    real cos_in = at_least_zero(-dot(hit->normal, path->ray.direction));
    struct refraction refraction = refract(path->ray.direction, hit->normal, cos_in, eta, kappa);
    struct dielectric_error error =
        track_refraction(path->ray.direction, path->error.direction, hit->normal, hit_error.normal,
                         refraction.direction, (double)eta, (double)kappa);
    double margin = path->followed ? margin_of(error.cos_out_squared, error.of_cos_out_squared) : INFINITY;
    note(&pixel->tally, refraction.total);
    TELL(record_split(cos_in, refraction));
    TELL(record_bounds(path->followed, errors_vector(error.refracted),
                       (struct vec3){(real)error.cos_in, (real)error.reflectance, 0}, 0, margin));
    double reflectance = refraction.total ? 1 : (double)refraction.reflectance;
    double e_split = path->weight * error.reflectance;
    struct tracked_path refracted = reflected;
    refracted.ray.direction = refraction.direction;
    refracted.ray.inward = !hit->from_inside;
    refracted.error.direction = error.refracted;
    refracted.branch = 2 * path->branch + 1;
    refracted.weight = path->weight * (1 - reflectance);
    refracted.e_weight =
        branch_error(path, refracted.weight,
                     path->e_weight * (1 - reflectance) + e_split + 2 * unit_roundoff * path->weight);
    if (!refraction.total)
        reflected.branch = 2 * path->branch + 2;
    reflected.weight = path->weight * reflectance;
    reflected.e_weight = branch_error(
        path, reflected.weight, path->e_weight * reflectance + e_split + unit_roundoff * reflected.weight);
    decide(pixel, &refracted, margin, CAUSE_REFLECTION);
    if (pixel->scene->quad_light_count > 0) /* the branch, by which light samples are drawn, is another */
        decide(pixel, &reflected, margin, CAUSE_REFLECTION);
    if (refraction.total) {
        trace_secondary(pixel, reflected);
        return;
    }
    if (!(reflected.weight > SMALLEST_WEIGHT))
        TELL(record_untraced(UNTRACED_REFLECTED, (real)reflected.weight, reflected.e_weight, 0));
    if (!(refracted.weight > SMALLEST_WEIGHT))
        TELL(record_untraced(UNTRACED_REFRACTED, (real)refracted.weight, refracted.e_weight, 0));
    trace_secondary(pixel, refracted);
    trace_secondary(pixel, reflected);
}

/* What follows a hit. */
static void scatter(struct pixel *pixel, const struct tracked_path *path, const struct hit *hit,
                    struct hit_error hit_error)
{
    const struct ray *ray = &path->ray;
    if (hit->material->tags.SURFACE_KIND == KIND_MATTE) {
        gather_matte(pixel, path, hit, hit_error);
        return;
    }
    if (path->bounces == pixel->scene->max_bounces) {
        TELL(record_untraced(UNTRACED_BOUNCES, (real)path->weight, path->e_weight, 0));
        return;
    }
    struct tracked_path reflected = *path;
    reflected.ray = (struct ray){
        .origin = hit->point,
        .direction = reflect(ray->direction, hit->normal, at_least_zero(-dot(hit->normal, ray->direction))),
        .surface = hit->surface,
        .inward = hit->from_inside,
    };
    if (path->followed)
        reflected.error =
            (struct ray_errors){hit_error.point, track_reflection(ray->direction, path->error.direction,
                                                                  hit->normal, hit_error.normal)};
    ++reflected.bounces;
    if (hit->material->tags.SURFACE_KIND == KIND_MIRROR)
        trace_secondary(pixel, reflected);
    else
        trace_dielectric(pixel, path, hit, hit_error, reflected);
}

/* Finds what the path's ray meets; float may not. */
static bool meet(struct pixel *pixel, struct tracked_path *path, struct hit *hit)
{
    const struct packed_scene *scene = pixel->scene;
    const struct ray_error error = {errors_length(path->error.origin), errors_length(path->error.direction)};
    bool met = find_hit(scene, &path->ray, hit);
    note(&pixel->tally, (uint32_t)(hit->surface + 1) * 2 + hit->from_inside);
    if (error.direction > unknown_angle)
        decide(pixel, path, 0, CAUSE_ROUNDING);
    double margin = path->followed ? hit_margin(scene, &path->ray, error, hit) : INFINITY;
    TELL(record_hit(hit));
    TELL(record_bounds(path->followed && !met, each(0), each(0), 0, margin));
    decide(pixel, path, margin, CAUSE_HIT);
    return met;
}

/* Whatever is known of a path's errors, they come to no more than all it may bring. */
static void trace(struct pixel *pixel, struct tracked_path path)
{
    const struct vec3 none = {0, 0, 0};
    const struct vec3 most = add(pixel->error, most_radiance(pixel, path.weight + path.e_weight));
    const bool followed = path.followed;
    struct hit hit;
    struct hit_error hit_error = {.distance = 0};
    TELL(record_ray(pixel->sample, &path.ray, (real)path.weight, path.bounces, path.branch));
    TELL(record_bounds(followed, errors_vector(path.error.origin), errors_vector(path.error.direction),
                       path.e_weight, INFINITY));
    if (!meet(pixel, &path, &hit)) {
        gather(pixel, &path, vector_of(pixel->scene->view.background), none, none);
    } else {
        if (path.followed) {
            hit_error = track_hit(pixel->scene, &path.ray, &path.error, &hit);
            TELL(record_bounds(true, errors_vector(hit_error.normal), errors_vector(hit_error.point),
                               hit_error.distance, last_event->margin));
            if (errors_length(hit_error.normal) > unknown_angle)
                decide(pixel, &path, 0, CAUSE_ROUNDING);
        }
        scatter(pixel, &path, &hit, hit_error);
    }
    if (followed)
        pixel->error = at_most(pixel->error, most);
}

struct reference_explanation REFERENCE_EXPLAIN(const struct packed_scene *scene, int x, int y,
                                               struct reference_log *log) {
    struct pixel pixel = {
        .scene = scene,
        .seed = pixel_seed(x, y),
        .margin = INFINITY,
    };
    event_log = log;
    for (uint32_t k = 0; k < (uint32_t)scene->samples; ++k) {
        pixel.sample = k;
        struct tracked_path path = {
            .ray = camera_ray(scene, x, y, k),
            .weight = 1,
            .followed = true,
        };
        path.error = track_primary(scene, path.ray.direction);
        trace(&pixel, path);
    }
    const real count = (real)scene->samples;
    const struct vec3 sum = pixel.radiance;
    const struct vec3 sum_error = scale(count > 1 ? count * (real)unit_roundoff : 0, sum);
    const struct vec3 error = add(scale(1 / count, add(pixel.error, sum_error)), each(SMALLEST_WEIGHT));
    const struct vec3 radiance = {sum.x / count, sum.y / count, sum.z / count};
    TELL(record(EVENT_PIXEL, (layout_ivec4){0}, radiance, each(0), 0));
    TELL(record_bounds(true, error, each(0), 0, pixel.margin));
    return (struct reference_explanation){
        .rgb = {(double)radiance.x, (double)radiance.y, (double)radiance.z},
        .bound = {(double)error.x, (double)error.y, (double)error.z},
        .margin = pixel.margin,
        .signature = pixel.tally.signature,
        .cause = pixel.cause,
    };
}
