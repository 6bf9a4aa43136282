/* The reference at high precision, with a running error analysis of what the float tracer does: for each
 * pixel the radiance, the path signature, how far the nearest decision is from going the other way in float,
 * and a bound on float's error if all decisions are the same. Built at double and binary128 with the entry's
 * name REFERENCE_EXPLAIN, or REFERENCE_RECORD for the one that tells what it does. */
#include "camera.h"
#include "events.h"
#include "light_margin.h"
#include "reference.h"
#include "tally.h"

struct pixel {
    const struct packed_scene *scene;
    uint32_t seed, sample;
    struct vec3 radiance, error;
    double margin;
    struct tally tally;
};

struct tracked_path {
    struct ray ray;
    struct ray_error error;
    double weight, e_weight;
    int bounces;
    uint32_t branch; /* of the ray tree, as in tracer.c */
};

static void trace(struct pixel *pixel, const struct tracked_path *path);

static void trace_secondary(struct pixel *pixel, const struct tracked_path *path)
{
    if (path->weight > SMALLEST_WEIGHT)
        trace(pixel, path);
}

static void gather(struct pixel *pixel, const struct tracked_path *path, struct vec3 radiance,
                   struct vec3 error)
{
    double relative = path->e_weight + rounding(path->weight);
    RECORD_LEAF(radiance, scale((real)path->weight, radiance));
    RECORD_BOUNDS(error, add(scale((real)path->weight, error), scale((real)relative, radiance)), 0, INFINITY);
    pixel->radiance = add(pixel->radiance, scale((real)path->weight, radiance));
    pixel->error = add(pixel->error, add(scale((real)path->weight, error), scale((real)relative, radiance)));
}

static void gather_matte(struct pixel *pixel, const struct tracked_path *path, const struct hit *hit,
                         struct hit_error hit_error)
{
    const struct packed_scene *scene = pixel->scene;
    uint32_t seed = hash32(pixel->seed + path->branch * (uint32_t)scene->quad_light_count);
    struct vec3 albedo = vector_of(hit->material->parameters), error;
    struct vec3 light = track_lights(scene, &path->ray, hit, hit_error, path->error.direction, seed,
                                     pixel->sample, &error, &pixel->tally, &pixel->margin);
    gather(pixel, path, multiply(albedo, light), multiply(albedo, error));
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
        track_refraction((double)cos_in, (double)eta, (double)kappa, path->error.direction, hit_error.normal);
    note(&pixel->tally, refraction.total);
    pixel->margin = smaller(pixel->margin, error.margin);
    RECORD_SPLIT(cos_in, refraction);
    RECORD_BOUNDS(each(error.refracted_direction),
                  ((struct vec3){(real)(path->error.direction + hit_error.normal + rounding(1)),
                                 (real)error.reflectance, 0}),
                  0, error.margin);
    if (refraction.total) {
        trace_secondary(pixel, &reflected);
        return;
    }
    double reflectance = (double)refraction.reflectance;
    double e_split = path->weight * error.reflectance + rounding(path->weight);
    struct tracked_path refracted = reflected;
    refracted.ray.direction = refraction.direction;
    refracted.ray.inward = !hit->from_inside;
    refracted.error.direction = error.refracted_direction;
    refracted.branch = 2 * path->branch + 1;
    refracted.weight = path->weight * (1 - reflectance);
    refracted.e_weight = path->e_weight * (1 - reflectance) + e_split;
    reflected.branch = 2 * path->branch + 2;
    reflected.weight = path->weight * reflectance;
    reflected.e_weight =
        path->e_weight * reflectance + path->weight * error.reflectance + rounding(reflected.weight);
    RECORD_UNTRACED(!(reflected.weight > SMALLEST_WEIGHT), UNTRACED_REFLECTED, reflected.weight,
                    reflected.e_weight, 0);
    RECORD_UNTRACED(!(refracted.weight > SMALLEST_WEIGHT), UNTRACED_REFRACTED, refracted.weight,
                    refracted.e_weight, 0);
    trace_secondary(pixel, &refracted);
    trace_secondary(pixel, &reflected);
}

/* Margin of what the path's ray hits; where the pixel's is lower already, and not all is told, no matter
 * what: among many spheres, a ray of which float knows little comes near most of them. */
static double margin_of_hit(const struct pixel *pixel, const struct tracked_path *path, const struct hit *hit)
{
    if (pixel->margin == 0 && !RECORDS)
        return 0;
    return hit_margin(pixel->scene, &path->ray, path->error, hit, RECORDS ? 1 : smaller(pixel->margin, 1));
}

static void trace(struct pixel *pixel, const struct tracked_path *path)
{
    const struct packed_scene *scene = pixel->scene;
    const struct ray *ray = &path->ray;
    struct hit hit;
    RECORD_RAY(pixel->sample, path);
    RECORD_BOUNDS(each(path->error.origin), each(path->error.direction), path->e_weight, INFINITY);
    bool met = find_hit(scene, ray, &hit);
    note(&pixel->tally, (uint32_t)(hit.surface + 1) * 2 + hit.from_inside);
    if (path->error.direction > 0.5)
        pixel->margin = 0; /* float knows no direction here */
    double margin = margin_of_hit(pixel, path, &hit);
    pixel->margin = smaller(pixel->margin, margin);
    RECORD_HIT(&hit);
    RECORD_BOUNDS(each(0), each(0), 0, margin);
    if (!met) {
        gather(pixel, path, vector_of(scene->view.background), (struct vec3){0, 0, 0});
        return;
    }
    struct hit_error hit_error = track_hit(scene, ray, path->error, &hit);
    RECORD_BOUNDS(each(hit_error.normal), each(hit_error.point),
                  distance_error(scene, ray, hit.surface, (double)hit.distance, path->error), margin);
    if (hit_error.normal > 0.5)
        pixel->margin = 0;
    if (hit.material->tags.SURFACE_KIND == KIND_MATTE) {
        gather_matte(pixel, path, &hit, hit_error);
        return;
    }
    if (path->bounces == scene->max_bounces) {
        RECORD_UNTRACED(true, UNTRACED_BOUNCES, path->weight, path->e_weight, 0);
        return;
    }
    struct tracked_path reflected = *path;
    reflected.ray = (struct ray){
        .origin = hit.point,
        .direction = reflect(ray->direction, hit.normal, at_least_zero(-dot(hit.normal, ray->direction))),
        .surface = hit.surface,
        .inward = hit.from_inside,
    };
    reflected.error =
        (struct ray_error){hit_error.point, track_reflection(path->error.direction, hit_error.normal)};
    ++reflected.bounces;
    if (hit.material->tags.SURFACE_KIND == KIND_MIRROR)
        trace_secondary(pixel, &reflected);
    else
        trace_dielectric(pixel, path, &hit, hit_error, reflected);
}

static struct pixel explain_pixel(const struct packed_scene *scene, int x, int y)
{
    struct pixel pixel = {
        .scene = scene,
        .seed = pixel_seed(x, y),
        .margin = INFINITY,
    };
    for (uint32_t k = 0; k < (uint32_t)scene->samples; ++k) {
        pixel.sample = k;
        struct tracked_path path = {
            .ray = camera_ray(scene, x, y, k),
            .error = {.origin = 0, .direction = rounding(1)},
            .weight = 1,
        };
        trace(&pixel, &path);
    }
    real count = (real)scene->samples;
    struct vec3 flushed = {(real)SMALLEST_WEIGHT, (real)SMALLEST_WEIGHT, (real)SMALLEST_WEIGHT};
    pixel.error = add(scale(1 / count, pixel.error), flushed);
    pixel.radiance =
        (struct vec3){pixel.radiance.x / count, pixel.radiance.y / count, pixel.radiance.z / count};
    return pixel;
}

#ifdef REFERENCE_RECORD

void REFERENCE_RECORD(const struct packed_scene *scene, int x, int y, struct reference_log *log)
{
    event_log = log;
    struct pixel pixel = explain_pixel(scene, x, y);
    RECORD(EVENT_PIXEL, (layout_ivec4){0}, pixel.radiance, each(0), 0);
    RECORD_BOUNDS(pixel.error, each(0), 0, pixel.margin);
}

#else

void REFERENCE_EXPLAIN(const struct packed_scene *scene, struct reference_window window, int threads,
                       struct reference_explanation *explanations)
{
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
            struct pixel pixel = explain_pixel(scene, window.x + column, window.y + row);
            explanations[(size_t)row * (size_t)window.width + (size_t)column] =
                (struct reference_explanation){
                    .rgb = {(double)pixel.radiance.x, (double)pixel.radiance.y, (double)pixel.radiance.z},
                    .bound = {(double)pixel.error.x, (double)pixel.error.y, (double)pixel.error.z},
                    .margin = pixel.margin,
                    .signature = pixel.tally.signature,
                };
        }
    }
}

#endif
