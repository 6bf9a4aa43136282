/* Whitted's recursion as the textbook writes it ("An Improved Illumination Model for Shaded Display", CACM
 * 23(6), 1980). Built once for each precision, with REFERENCE_BITS and the entry's name REFERENCE_TRACE. */
#include "camera.h"
#include "dielectric.h"
#include "escape.h"
#include "events.h"
#include "geometry.h"
#include "matte.h"
#include "reference.h"
#include "sobol.h"

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
    TELL(record_leaf(radiance, leaf));
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
    TELL(record_split(cos_in, refraction));
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
    if (!reflects)
        TELL(record_untraced(UNTRACED_REFLECTED, reflected.weight, 0, sample->charge));
    if (!refracts)
        TELL(record_untraced(UNTRACED_REFRACTED, refracted.weight, 0, sample->charge));
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
    TELL(record_ray(sample->index, ray, path->weight, path->bounces, path->branch));
    bool met = find_hit(scene, ray, &hit);
    TELL(record_hit(&hit));
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
        TELL(record_untraced(UNTRACED_BOUNCES, path->weight, 0, sample->charge));
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
    if (escaping)
        TELL(record_untraced(UNTRACED_ESCAPES, path->weight, 0, sample->charge));
    else
        trace_secondary(sample, &reflected);
}

/* A NaN stays to be seen. */
static double flush_small(real x)
{
    return x < (real)SMALLEST_WEIGHT ? 0.0 : (double)x;
}

struct reference_pixel REFERENCE_TRACE(const struct packed_scene *scene, int x, int y,
                                       struct reference_log *log) {
    struct vec3 sum = {0, 0, 0};
    real charges = 0;
    struct tally tally = {.signature = 0};
    event_log = log;
    for (uint32_t k = 0; k < (uint32_t)scene->samples; ++k) {
        struct sample sample = {
            .scene = scene,
            .seed = pixel_seed(x, y),
            .index = k,
            .room = (real)scene->view.truncation.ALLOWANCE,
            .tally = tally,
        };
        struct path path = {.ray = camera_ray(scene, x, y, k), .weight = 1};
        ++sample.tally.rays.primary;
        trace(&sample, &path);
        struct vec3 radiance = add(sample.radiance, sample.rounding);
        TELL(record(EVENT_SAMPLE, (layout_ivec4){0}, radiance, each(0), sample.charge));
        sum = add(sum, radiance);
        charges = (charges + sample.charge) * (real)ROUND_UP;
        tally = sample.tally;
    }
    real count = (real)scene->samples;
    struct reference_pixel pixel = {
        .rgb = {flush_small(sum.x / count), flush_small(sum.y / count), flush_small(sum.z / count)},
        .charges = (double)charges,
        .signature = tally.signature,
        .rays = tally.rays,
    };
    struct vec3 flushed = {(real)pixel.rgb[0], (real)pixel.rgb[1], (real)pixel.rgb[2]};
    TELL(record(EVENT_PIXEL, (layout_ivec4){0}, flushed, each(0), 0));
    return pixel;
}
