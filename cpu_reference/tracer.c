/* Whitted's recursion as the textbook writes it ("An Improved Illumination Model for Shaded Display", CACM
 * 23(6), 1980). Built once for each precision, with REFERENCE_BITS and the entry's name REFERENCE_RENDER. */
#include "camera.h"
#include "dielectric.h"
#include "geometry.h"
#include "matte.h"
#include "reference.h"
#include "sobol.h"
#include "tally.h"

/* What tracing one pixel reads and gathers. */
struct pixel {
    const struct packed_scene *scene;
    uint32_t seed, sample;
    uint32_t shaded; /* matte points of this sample so far: each draws light samples of its own */
    struct vec3 radiance;
    struct tally tally;
};

static void trace(struct pixel *pixel, const struct ray *ray, real weight, int bounces);

static void trace_secondary(struct pixel *pixel, const struct ray *ray, real weight, int bounces)
{
    if (!(weight > (real)SMALLEST_WEIGHT))
        return;
    ++pixel->tally.rays.secondary;
    trace(pixel, ray, weight, bounces);
}

static void gather(struct pixel *pixel, real weight, struct vec3 radiance)
{
    pixel->radiance = add(pixel->radiance, scale(weight, radiance));
}

/* Adds what the ray sees, times weight, to the pixel. */
static void trace(struct pixel *pixel, const struct ray *ray, real weight, int bounces)
{
    const struct packed_scene *scene = pixel->scene;
    struct hit hit;
    bool met = find_hit(scene, ray, &hit);
    note(&pixel->tally, (uint32_t)(hit.surface + 1) * 2 + hit.leaving);
    if (!met) {
        gather(pixel, weight, vector_of(scene->view.background));
        return;
    }
    if (hit.material->tags.x == KIND_MATTE) {
        uint32_t seed = hash32(pixel->seed + pixel->shaded * (uint32_t)scene->quad_light_count);
        ++pixel->shaded;
        gather(pixel, weight, reflect_lights(scene, ray, &hit, seed, pixel->sample, &pixel->tally));
        return;
    }
    if (bounces == scene->max_bounces)
        return;

    real cos_in = at_least_zero(-dot(hit.normal, ray->direction));
    struct ray reflected = {
        .origin = hit.point,
        .direction = reflect(ray->direction, hit.normal, cos_in),
        .surface = hit.surface,
        .inward = hit.leaving,
    };
    if (hit.material->tags.x == KIND_MIRROR) {
        trace_secondary(pixel, &reflected, weight, bounces + 1);
        return;
    }
    layout_vec4 ior = hit.material->parameters;
    struct refraction refraction = hit.leaving ? refract(ray->direction, hit.normal, cos_in, ior.z, ior.w)
                                               : refract(ray->direction, hit.normal, cos_in, ior.x, ior.y);
    note(&pixel->tally, refraction.total);
    if (refraction.total) {
        trace_secondary(pixel, &reflected, weight, bounces + 1);
        return;
    }
    struct ray refracted = reflected;
    refracted.direction = refraction.direction;
    refracted.inward = !hit.leaving;
    trace_secondary(pixel, &refracted, weight * (1 - refraction.reflectance), bounces + 1);
    trace_secondary(pixel, &reflected, weight * refraction.reflectance, bounces + 1);
}

static struct pixel trace_pixel(const struct packed_scene *scene, int x, int y)
{
    struct pixel pixel = {.scene = scene, .seed = pixel_seed(x, y)};
    for (uint32_t k = 0; k < (uint32_t)scene->samples; ++k) {
        pixel.sample = k;
        pixel.shaded = 0;
        struct ray ray = camera_ray(scene, x, y, k);
        ++pixel.tally.rays.primary;
        trace(&pixel, &ray, 1, 0);
    }
    if (scene->samples > 1) {
        real count = (real)scene->samples;
        pixel.radiance =
            (struct vec3){pixel.radiance.x / count, pixel.radiance.y / count, pixel.radiance.z / count};
    }
    return pixel;
}

/* A NaN stays to be seen. */
static double flush_small(real x)
{
    return x < (real)SMALLEST_WEIGHT ? 0.0 : (double)x;
}

void REFERENCE_RENDER(const struct packed_scene *scene, struct reference_window window, int threads,
                      double *rgb, uint32_t *signatures, struct reference_rays *rays)
{
    uint64_t primary = 0, secondary = 0, shadow = 0;
#pragma omp parallel for schedule(dynamic) num_threads(threads) reduction(+ : primary, secondary, shadow)
    for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
            struct pixel pixel = trace_pixel(scene, window.x + column, window.y + row);
            double *out = rgb + ((size_t)row * (size_t)window.width + (size_t)column) * 3;
            out[0] = flush_small(pixel.radiance.x);
            out[1] = flush_small(pixel.radiance.y);
            out[2] = flush_small(pixel.radiance.z);
            if (signatures)
                signatures[(size_t)row * (size_t)window.width + (size_t)column] = pixel.tally.signature;
            primary += pixel.tally.rays.primary;
            secondary += pixel.tally.rays.secondary;
            shadow += pixel.tally.rays.shadow;
        }
    }
    rays->primary += primary;
    rays->secondary += secondary;
    rays->shadow += shadow;
}
