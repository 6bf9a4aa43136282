/* What is counted on the way of a pixel, and how the tracer tells what it does, step by step, where the
 * caller wants to know. */
#ifndef REFERENCE_EVENTS_H
#define REFERENCE_EVENTS_H

#include "dielectric.h"
#include "geometry.h"
#include "reference.h"
#include "sobol.h"

struct tally {
    struct reference_rays rays;
    uint32_t signature; /* hash of every decision of the ray tree */
};

static inline void note(struct tally *tally, uint32_t decision)
{
    tally->signature = hash32(tally->signature + decision);
}

static _Thread_local struct reference_log *event_log; /* NULL: nobody wants to know */

/* Tells it to the log, if there is one. */
#define TELL(statement)                                                                                      \
    do {                                                                                                     \
        if (event_log)                                                                                       \
            statement;                                                                                       \
    } while (0)

static _Thread_local struct reference_event *last_event; /* or a place for what is not kept */
static _Thread_local layout_ivec4 event_place;

/* What is known so far of the light point that is being looked at. */
static _Thread_local struct {
    int state, blocker;
    struct vec3 values; /* distance, cos_in, received */
    bool known;         /* what the bounds are */
    struct vec3 bounds, point_bounds;
    double area_bound;
    double margin;
} event_light;

static inline void record(int kind, layout_ivec4 facts, struct vec3 first, struct vec3 second, real third)
{
    static _Thread_local struct reference_event not_kept;
    last_event = event_log->count < event_log->room ? &event_log->events[event_log->count] : &not_kept;
    ++event_log->count;
    event_place.EVENT_KIND = kind;
    *last_event = (struct reference_event){
        .head = {event_place, facts},
        .values = {(double)first.x, (double)first.y, (double)first.z, (double)second.x, (double)second.y,
                   (double)second.z, (double)third},
        .margin = INFINITY,
    };
}

/* Where they are not known, they are infinite. */
static inline void record_bounds(bool known, struct vec3 first, struct vec3 second, double third,
                                 double margin)
{
    const double bounds[EVENT_VALUES] = {(double)first.x,
                                         (double)first.y,
                                         (double)first.z,
                                         (double)second.x,
                                         (double)second.y,
                                         (double)second.z,
                                         third};
    for (int i = 0; i < EVENT_VALUES; ++i)
        last_event->bounds[i] = known ? bounds[i] : INFINITY;
    last_event->margin = margin;
}

static inline struct vec3 each(double bound)
{
    return (struct vec3){(real)bound, (real)bound, (real)bound};
}

static inline void record_ray(uint32_t sample, const struct ray *ray, real weight, int bounces,
                              uint32_t branch)
{
    event_place =
        (layout_ivec4){.EVENT_OF_SAMPLE = (int)sample, .EVENT_BRANCH = (int)branch, .EVENT_BOUNCES = bounces};
    record(EVENT_RAY, (layout_ivec4){.EVENT_SURFACE = ray->surface, .EVENT_INWARD = ray->inward}, ray->origin,
           ray->direction, weight);
}

static inline void record_hit(const struct hit *hit)
{
    record(EVENT_HIT, (layout_ivec4){.EVENT_SURFACE = hit->surface, .EVENT_FROM_INSIDE = hit->from_inside},
           hit->normal, hit->point, hit->surface < 0 ? 0 : hit->distance);
}

static inline void record_split(real cos_in, struct refraction refraction)
{
    record(EVENT_SPLIT, (layout_ivec4){.EVENT_TOTAL = refraction.total}, refraction.direction,
           (struct vec3){cos_in, refraction.reflectance, 0}, 0);
}

static inline void record_untraced(int why, real weight, double weight_bound, real charge)
{
    record(EVENT_UNTRACED, (layout_ivec4){.EVENT_REASON = why}, (struct vec3){weight, charge, 0}, each(0), 0);
    record_bounds(true, each(weight_bound), each(0), 0, INFINITY);
}

static inline void record_leaf(struct vec3 seen, struct vec3 leaf)
{
    record(EVENT_LEAF, (layout_ivec4){0}, seen, leaf, 0);
}

/* How far the light point has got: LIGHT_. */
static inline void note_light(int state, real distance, real cos_in)
{
    event_light.state = state;
    event_light.blocker = NO_SURFACE;
    event_light.values = (struct vec3){distance, cos_in, 0};
    event_light.known = false;
    event_light.margin = INFINITY;
}

static inline void note_light_bounds(struct vec3 point, double distance, double cos_in, double received,
                                     double margin)
{
    event_light.bounds = (struct vec3){(real)distance, (real)cos_in, (real)received};
    event_light.point_bounds = point;
    event_light.known = true;
    event_light.margin = margin;
}

static inline void record_light(int light, int sample, struct vec3 point, real area)
{
    record(EVENT_LIGHT, (layout_ivec4){light, sample, event_light.state, event_light.blocker}, point,
           event_light.values, area);
    record_bounds(event_light.known, event_light.point_bounds, event_light.bounds, event_light.area_bound,
                  event_light.margin);
}

#endif
