// What a tracer tells of one pixel: with TRACE_EVENTS, each step of the dispatch's first pixel goes to a buffer.
// In the ordinary pipelines TELL() is empty.

#ifdef TRACE_EVENTS

#define TELL(statement) statement
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

// A dispatch that takes up a ray where another left it knows its place, too. (Macros, as the types come later.)
#define emit_ray(when, sample_index, path)                                                                 \
    event_place = ivec4(0, sample_index, path.branch, path.bounces);                                       \
    if (when)                                                                                              \
        emit(EVENT_RAY, ivec4(path.ray.surface, path.ray.inward, 0, 0), path.ray.origin,                   \
             path.ray.direction, path.weight);
#define emit_hit(hit, point, normal)                                                                       \
    emit(EVENT_HIT, ivec4(hit.surface, hit.from_inside, 0, 0), hit.surface >= 0 ? normal : real3(0),       \
         hit.surface >= 0 ? point : real3(0), hit.surface >= 0 ? hit.distance : real(0))
#define emit_split(cos_in, refraction)                                                                     \
    emit(EVENT_SPLIT, ivec4(refraction.total, 0, 0, 0),                                                    \
         refraction.total ? real3(0) : refraction.direction,                                               \
         real3(cos_in, refraction.total ? real(0) : refraction.reflectance, 0), real(0))

void emit_untraced(int why, real weight, real charge)
{
    emit(EVENT_UNTRACED, ivec4(why, 0, 0, 0), real3(weight, charge, 0), real3(0), real(0));
}

// Of the light point that is being looked at.
int light_state, light_blocker;
real3 light_values; // distance, cos_in, irradiance

void note_blocker(int i, bool shadowed)
{
    light_blocker = shadowed && light_blocker < 0 ? i : light_blocker;
}

void note_light(real distance_squared, real distance, real cos_in, real irradiance)
{
    bool far = distance_squared > real(NEAREST_LIGHT_SQUARED);
    light_state = !far ? LIGHT_TOO_NEAR : cos_in > real(0) ? LIGHT_SHADOW_RAY : LIGHT_BEHIND;
    light_values = real3(far ? distance : real(0), far ? cos_in : real(0), irradiance);
    light_blocker = light_state == LIGHT_SHADOW_RAY ? light_blocker : -1;
}

void emit_light(int i, int k, real3 light, real area)
{
    emit(EVENT_LIGHT, ivec4(i, k, light_state, light_blocker), light, light_values, area);
}

#else

#define TELL(statement)
const bool RECORDS = false;
const int NO_QUAD_LIGHTS = 0;

#endif
