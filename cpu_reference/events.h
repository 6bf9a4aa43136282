/* How the tracer tells what it does, step by step: only where it is built with REFERENCE_RECORD, the entry's
 * name, for one pixel and one thread at a time. Elsewhere the calls are empty. */
#ifndef REFERENCE_EVENTS_H
#define REFERENCE_EVENTS_H

#ifdef REFERENCE_RECORD

#include "geometry.h"
#include "reference_events.h"

static _Thread_local struct reference_log *event_log;
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

/* The first of the spheres that the tree has and that stand between the ends; sphere_count if there is none.
 */
static inline int find_blocker_in_tree(const struct packed_scene *scene, const struct segment *segment)
{
    int first = scene->sphere_count, own = segment->surface;
    if (is_in_tree(scene, own) && sphere_blocks(&scene->spheres[own], own, segment))
        first = own;
    struct sphere_walk walk = walk_segment(scene, segment);
    for (int i; (i = sphere_walk_next(&walk)) != NO_MORE_SPHERES;)
        if (i < first && sphere_blocks(&scene->spheres[i], i, segment))
            first = i;
    return first;
}

/* The first object that stands between the ends, which is there. */
static inline int find_blocker(const struct packed_scene *scene, const struct segment *segment)
{
    int i = 0;
    while (i < tried_spheres(scene) && !tried_sphere_blocks(scene, i, segment))
        ++i;
    if (scene->tree && i == tried_spheres(scene))
        i = find_blocker_in_tree(scene, segment);
    while (i >= scene->sphere_count && !plane_blocks(&scene->planes[i - scene->sphere_count], i, segment))
        ++i;
    return i;
}

#define RECORD(kind, facts, first, second, third) record(kind, facts, first, second, third)
#define RECORD_BOUNDS(known, first, second, third, margin) record_bounds(known, first, second, third, margin)
#define RECORD_RAY(sample, path)                                                                             \
    record_ray(sample, &(path)->ray, (real)(path)->weight, (path)->bounces, (path)->branch)
#define RECORD_HIT(hit)                                                                                      \
    record(EVENT_HIT,                                                                                        \
           (layout_ivec4){.EVENT_SURFACE = (hit)->surface, .EVENT_FROM_INSIDE = (hit)->from_inside},         \
           (hit)->normal, (hit)->point, (hit)->surface < 0 ? 0 : (hit)->distance)
#define RECORD_SPLIT(cos_in, refraction)                                                                     \
    record(EVENT_SPLIT, (layout_ivec4){.EVENT_TOTAL = (refraction).total}, (refraction).direction,           \
           (struct vec3){cos_in, (refraction).reflectance, 0}, 0)
#define RECORD_UNTRACED(when, why, weight, weight_bound, charge)                                             \
    if (when)                                                                                                \
    record(EVENT_UNTRACED, (layout_ivec4){.EVENT_REASON = why}, (struct vec3){(real)(weight), charge, 0},    \
           (struct vec3){0, 0, 0}, 0),                                                                       \
        record_bounds(true, each(weight_bound), each(0), 0, INFINITY)
#define RECORD_LEAF(seen, leaf) record(EVENT_LEAF, (layout_ivec4){0, 0, 0, 0}, seen, leaf, 0)

#define NOTE_LIGHT_TOO_NEAR()                                                                                \
    event_light.state = LIGHT_TOO_NEAR, event_light.blocker = NO_SURFACE, event_light.values = each(0),      \
    event_light.known = false, event_light.margin = INFINITY
#define NOTE_LIGHT_BEHIND(distance, cos_in)                                                                  \
    event_light.state = LIGHT_BEHIND, event_light.values = (struct vec3)                                     \
    {                                                                                                        \
        distance, cos_in, 0                                                                                  \
    }
#define NOTE_SHADOW_RAY() event_light.state = LIGHT_SHADOW_RAY
#define NOTE_BLOCKED(scene, segment) event_light.blocker = find_blocker(scene, segment)
#define NOTE_RECEIVED(received) event_light.values.z = received
#define NOTE_LIGHT_BOUNDS(point, distance, cos_in, received, of_margin)                                      \
    event_light.bounds = (struct vec3){(real)(distance), (real)(cos_in), (real)(received)},                  \
    event_light.point_bounds = errors_vector(point), event_light.known = true,                               \
    event_light.margin = of_margin
#define NOTE_AREA_BOUND(area) event_light.area_bound = area
#define RECORD_LIGHT(light, sample, point, area)                                                             \
    record(EVENT_LIGHT, (layout_ivec4){light, sample, event_light.state, event_light.blocker}, point,        \
           event_light.values, area),                                                                        \
        record_bounds(event_light.known, event_light.point_bounds, event_light.bounds,                       \
                      event_light.area_bound, event_light.margin)

#else

#define RECORD(kind, facts, first, second, third)
#define RECORD_BOUNDS(known, first, second, third, margin)
#define RECORD_RAY(sample, path)
#define RECORD_HIT(hit)
#define RECORD_SPLIT(cos_in, refraction)
#define RECORD_UNTRACED(when, why, weight, weight_bound, charge)
#define RECORD_LEAF(seen, leaf)
#define NOTE_LIGHT_TOO_NEAR()
#define NOTE_LIGHT_BEHIND(distance, cos_in)
#define NOTE_SHADOW_RAY()
#define NOTE_BLOCKED(scene, segment)
#define NOTE_RECEIVED(received)
#define NOTE_LIGHT_BOUNDS(point, distance, cos_in, received, of_margin)
#define NOTE_AREA_BOUND(area)
#define RECORD_LIGHT(light, sample, point, area)

#endif

#endif
