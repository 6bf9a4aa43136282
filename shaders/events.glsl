// What a tracer tells of one pixel: with TRACE_EVENTS, each step of the dispatch's first pixel goes to a buffer.
// In the ordinary pipelines the calls are empty.

#ifdef TRACE_EVENTS

const bool RECORDS = true;
const int NO_QUAD_LIGHTS = -1; // fewer than none: light or not, each ray tells its branch

struct Event {
    EventHead head;
    real values[EVENT_VALUES];
};

// More events than there is room for are counted and not written.
layout(std430, set = 0, binding = 12) buffer EventBlock {
    uint event_count, event_room, event_unused[2];
    Event events[];
};

bool records_pixel = false; // this invocation, at this time
ivec4 event_place = ivec4(0);

void emit(int kind, ivec4 facts, real3 first, real3 second, real third)
{
    if (!records_pixel)
        return;
    uint i = event_count;
    event_count = i + 1u;
    if (i >= event_room)
        return;
    events[i].head.place = ivec4(kind, event_place.yzw);
    events[i].head.facts = facts;
    for (int c = 0; c < 3; ++c) {
        events[i].values[c] = first[c];
        events[i].values[3 + c] = second[c];
    }
    events[i].values[6] = third;
    events[i].values[7] = real(0);
}

#define begin_events(starts)                      \
    if (starts && gl_GlobalInvocationID == uvec3(0)) \
        event_count = 0u;
#define records(in_tile) records_pixel = in_tile == uvec2(0)

// A dispatch that takes up a ray where another left it knows its place, too.
#define emit_ray(when, sample_index, path)                                                                 \
    event_place = ivec4(0, sample_index, path.branch, path.bounces);                                       \
    if (when)                                                                                              \
        emit(EVENT_RAY, ivec4(path.ray.surface, path.ray.inward, 0, 0), path.ray.origin,                   \
             path.ray.direction, path.weight);
#define emit_hit(when, hit, point, normal)                                                                 \
    if (when) {                                                                                                    \
        bool met = hit.surface >= 0;                                                                       \
        emit(EVENT_HIT, ivec4(hit.surface, hit.from_inside, 0, 0), met ? normal : real3(0),                    \
             met ? point : real3(0), met ? hit.distance : real(0));                                        \
    }
#define emit_split(cos_in, refraction)                                                                     \
    emit(EVENT_SPLIT, ivec4(refraction.total, 0, 0, 0),                                                    \
         refraction.total ? real3(0) : refraction.direction,                                               \
         real3(cos_in, refraction.total ? real(0) : refraction.reflectance, 0), real(0))
#define emit_untraced(when, why, weight, charge)                                                           \
    if (when)                                                                                              \
    emit(EVENT_UNTRACED, ivec4(why, 0, 0, 0), real3(weight, charge, 0), real3(0), real(0))
#define emit_leaf(seen, leaf) emit(EVENT_LEAF, ivec4(0), seen, leaf, real(0))
#define emit_sample(radiance, charge) emit(EVENT_SAMPLE, ivec4(0), radiance, real3(0), charge)
#define emit_pixel(value) emit(EVENT_PIXEL, ivec4(0), value, real3(0), real(0))

// Of the light point that is being looked at.
int light_state, light_blocker;
real3 light_values; // distance, cos_in, irradiance

#define note_no_blocker() light_blocker = -1
#define note_blocker(i, shadowed) light_blocker = shadowed && light_blocker < 0 ? i : light_blocker
void note_light(real distance_squared, real distance, real cos_in, real irradiance)
{
    bool far = distance_squared > real(NEAREST_LIGHT_SQUARED);
    light_state = !far ? LIGHT_TOO_NEAR : cos_in > real(0) ? LIGHT_SHADOW_RAY : LIGHT_BEHIND;
    light_values = real3(far ? distance : real(0), far ? cos_in : real(0), irradiance);
    light_blocker = light_state == LIGHT_SHADOW_RAY ? light_blocker : -1;
}
#define emit_light(i, k, light, area)                                                                      \
    emit(EVENT_LIGHT, ivec4(i, k, light_state, light_blocker), light, light_values, area)

#else

const bool RECORDS = false;
const int NO_QUAD_LIGHTS = 0;
#define begin_events(starts)
#define records(in_tile)
#define emit_ray(when, sample_index, path)
#define emit_hit(when, hit, point, normal)
#define emit_split(cos_in, refraction)
#define emit_untraced(when, why, weight, charge)
#define emit_leaf(seen, leaf)
#define emit_sample(radiance, charge)
#define emit_pixel(value)
#define note_no_blocker()
#define note_blocker(i, shadowed)
#define note_light(distance_squared, distance, cos_in, irradiance)
#define emit_light(i, k, light, area)

#endif
