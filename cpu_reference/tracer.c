/* Whitted's recursion as the textbook writes it ("An Improved Illumination Model for Shaded Display", CACM
 * 23(6), 1980). Built once for each precision, with REFERENCE_BITS and the entry's name REFERENCE_RENDER,
 * or REFERENCE_RECORD for the one that tells what it does. */
#include "camera.h"
#include "dielectric.h"
#include "escape.h"
#include "events.h"
#include "geometry.h"
#include "matte.h"
#include "reference.h"
#include "sobol.h"
#include "tally.h"

/* What tracing one sample of a pixel reads and gathers. */
struct sample {
    const struct packed_scene *scene;
    uint32_t seed, index;
    struct vec3 radiance, rounding; /* the rounded sum, and what rounding took from it */
    real charge;                    /* the weight of rays that were not traced, see ROUND_UP */
    real room;                      /* what is left of the allowance for them */
    real waiting;                   /* the roots of the weights of rays that are put off, summed */
    struct tally tally;
};

struct path {
    struct ray ray;
    real weight;
    int bounces;
    uint32_t branch; /* of the binary ray tree that glass makes: 0 the root; of i, 2 i + 1 refracted, 2 i + 2
                      * reflected */
};

static void trace(struct sample *sample, const struct path *path);

static void trace_secondary(struct sample *sample, const struct path *path)
{
    ++sample->tally.rays.secondary;
    trace(sample, path);
}

static real charged(const struct sample *sample, real weight)
{
    return (sample->charge + weight) * (real)ROUND_UP;
}

/* For a ray that is not traced. Where max_bounces cuts off too much, the room is kept for the rays that are
 * left out by choice. */
static void charge(struct sample *sample, real weight)
{
    sample->charge = charged(sample, weight);
    if (!(weight <= sample->room))
        return;
    sample->room = (sample->room - weight) * (real)ROUND_DOWN;
    if (sample->room < (real)sample->scene->view.truncation.ALLOWANCE * (real)LEAST_ROOM)
        sample->room = 0;
}

static real root_of(real weight)
{
    return weight > (real)SMALLEST_WEIGHT ? square_root(weight) : 0;
}

/* Whether a ray of this weight may be left out, where the roots of all rays still to be traced, this one
 * included, come to `open`; see NUMERICS.md. */
static bool may_be_left_out(const struct sample *sample, real weight, real open)
{
    const layout_vec4 *truncation = &sample->scene->view.truncation;
    real allowance = (real)truncation->ALLOWANCE, room = sample->room;
    bool too_late = sample->charge > allowance; /* to keep the order */
    if (allowance < 0 || !(weight <= room) || !(too_late || charged(sample, weight) <= allowance))
        return false;
    return root_of(weight) * open * open <= room * (room * (real)truncation->SPENDING);
}

/* Whether the ray is to be traced; where it is not, the sample has been charged for it. */
static bool is_traced(struct sample *sample, real weight, real open)
{
    if (weight > (real)SMALLEST_WEIGHT && !may_be_left_out(sample, weight, open))
        return true;
    charge(sample, weight);
    return false;
}

/* Knuth's two-sum (TAOCP 2, 4.2.2): returns a + b and adds the rounding error, exactly, to *rounding. */
static real add_exactly(real a, real b, real *rounding)
{
    real sum = a + b;
    real added = sum - a;
    *rounding += (a - (sum - added)) + (b - added);
    return sum;
}

static void gather(struct sample *sample, real weight, struct vec3 radiance)
{
    struct vec3 leaf = scale(weight, radiance);
    RECORD_LEAF(radiance, leaf);
    sample->radiance.x = add_exactly(sample->radiance.x, leaf.x, &sample->rounding.x);
    sample->radiance.y = add_exactly(sample->radiance.y, leaf.y, &sample->rounding.y);
    sample->radiance.z = add_exactly(sample->radiance.z, leaf.z, &sample->rounding.z);
}

static void trace_dielectric(struct sample *sample, const struct path *path, const struct hit *hit,
                             struct path reflected)
{
    struct vec3 direction = path->ray.direction;
    real cos_in = at_least_zero(-dot(hit->normal, direction));
    layout_vec4 glass = hit->material->parameters;
    struct refraction refraction =
        hit->from_inside ? refract(direction, hit->normal, cos_in, glass.ETA_EXITING, glass.KAPPA_EXITING)
                         : refract(direction, hit->normal, cos_in, glass.ETA_ENTERING, glass.KAPPA_ENTERING);
    note(&sample->tally, refraction.total);
    RECORD_SPLIT(cos_in, refraction);
    if (refraction.total) {
        trace_secondary(sample, &reflected);
        return;
    }
    struct path refracted = reflected;
    refracted.ray.direction = refraction.direction;
    refracted.ray.inward = !hit->from_inside;
    refracted.weight = path->weight * (1 - refraction.reflectance);
    refracted.branch = 2 * path->branch + 1;
    reflected.weight = path->weight * refraction.reflectance;
    reflected.branch = 2 * path->branch + 2;
    real open = sample->waiting + root_of(reflected.weight) + root_of(refracted.weight);
    bool reflects = is_traced(sample, reflected.weight, open);
    bool refracts = is_traced(sample, refracted.weight, open);
    RECORD_UNTRACED(!reflects, UNTRACED_REFLECTED, reflected.weight, 0, sample->charge);
    RECORD_UNTRACED(!refracts, UNTRACED_REFRACTED, refracted.weight, 0, sample->charge);
    if (refracts && reflects) {
        sample->waiting += root_of(reflected.weight);
        trace_secondary(sample, &refracted);
        sample->waiting -= root_of(reflected.weight);
    } else if (refracts) {
        trace_secondary(sample, &refracted);
    }
    if (reflects)
        trace_secondary(sample, &reflected);
}

/* Adds what the path's ray sees, times its weight, to the sample. */
static void trace(struct sample *sample, const struct path *path)
{
    const struct packed_scene *scene = sample->scene;
    const struct ray *ray = &path->ray;
    struct hit hit;
    RECORD_RAY(sample->index, path);
    bool met = find_hit(scene, ray, &hit);
    RECORD_HIT(&hit);
    note(&sample->tally, (uint32_t)(hit.surface + 1) * 2 + hit.from_inside);
    if (!met) {
        gather(sample, path->weight, vector_of(scene->view.background));
        return;
    }
    if (hit.material->tags.SURFACE_KIND == KIND_MATTE) {
        /* each branch draws light samples of its own, the same whichever others are traced */
        uint32_t seed = hash32(sample->seed + path->branch * (uint32_t)scene->quad_light_count);
        gather(sample, path->weight, reflect_lights(scene, ray, &hit, seed, sample->index, &sample->tally));
        return;
    }
    if (path->bounces == scene->max_bounces) {
        charge(sample, path->weight);
        RECORD_UNTRACED(true, UNTRACED_BOUNCES, path->weight, 0, sample->charge);
        return;
    }
    struct path reflected = *path;
    ++reflected.bounces;
    reflected.ray = (struct ray){
        .origin = hit.point,
        .direction = reflect(ray->direction, hit.normal, at_least_zero(-dot(hit.normal, ray->direction))),
        .surface = hit.surface,
        .inward = hit.from_inside,
    };
    if (hit.material->tags.SURFACE_KIND == KIND_TRANSPARENT) {
        trace_dielectric(sample, path, &hit, reflected);
        return;
    }
    bool escaping = scene->view.between_mirrors.w != 0 && escapes(scene, &reflected.ray);
    RECORD_UNTRACED(escaping, UNTRACED_ESCAPES, path->weight, 0, sample->charge);
    if (!escaping)
        trace_secondary(sample, &reflected);
}

struct pixel {
    struct vec3 radiance;
    real charges; /* summed over the samples */
    struct tally tally;
};

static struct pixel trace_pixel(const struct packed_scene *scene, int x, int y)
{
    struct pixel pixel = {.charges = 0};
    for (uint32_t k = 0; k < (uint32_t)scene->samples; ++k) {
        struct sample sample = {
            .scene = scene,
            .seed = pixel_seed(x, y),
            .index = k,
            .room = (real)scene->view.truncation.ALLOWANCE,
            .tally = pixel.tally,
        };
        struct path path = {.ray = camera_ray(scene, x, y, k), .weight = 1};
        ++sample.tally.rays.primary;
        trace(&sample, &path);
        struct vec3 radiance = add(sample.radiance, sample.rounding);
        RECORD(EVENT_SAMPLE, (layout_ivec4){0}, radiance, (struct vec3){0}, sample.charge);
        pixel.radiance = add(pixel.radiance, radiance);
        pixel.charges = (pixel.charges + sample.charge) * (real)ROUND_UP;
        pixel.tally = sample.tally;
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

#ifdef REFERENCE_RECORD

void REFERENCE_RECORD(const struct packed_scene *scene, int x, int y, struct reference_log *log)
{
    event_log = log;
    struct vec3 radiance = trace_pixel(scene, x, y).radiance;
    struct vec3 flushed = {(real)flush_small(radiance.x), (real)flush_small(radiance.y),
                           (real)flush_small(radiance.z)};
    RECORD(EVENT_PIXEL, (layout_ivec4){0}, flushed, (struct vec3){0}, 0);
}

#else

void REFERENCE_RENDER(const struct packed_scene *scene, struct reference_window window, int threads,
                      struct reference_picture *picture)
{
    uint64_t primary = 0, secondary = 0, shadow = 0;
#pragma omp parallel for schedule(dynamic) num_threads(threads) reduction(+ : primary, secondary, shadow)
    for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
            struct pixel pixel = trace_pixel(scene, window.x + column, window.y + row);
            size_t place = (size_t)row * (size_t)window.width + (size_t)column;
            picture->rgb[3 * place] = flush_small(pixel.radiance.x);
            picture->rgb[3 * place + 1] = flush_small(pixel.radiance.y);
            picture->rgb[3 * place + 2] = flush_small(pixel.radiance.z);
            if (picture->signatures)
                picture->signatures[place] = pixel.tally.signature;
            if (picture->charges)
                picture->charges[place] = (double)pixel.charges;
            primary += pixel.tally.rays.primary;
            secondary += pixel.tally.rays.secondary;
            shadow += pixel.tally.rays.shadow;
        }
    }
    rays_add(&picture->rays, (struct reference_rays){primary, secondary, shadow});
}

#endif
