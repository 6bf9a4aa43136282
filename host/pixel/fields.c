#include "pixel/fields.h"

#include <math.h>
#include <string.h>

static const struct event_field fields[EVENT_KINDS][10] =
    {
        [EVENT_RAY] =
            {
                {"leaves", FIELD_OBJECT, 0, 1, 0},
                {"inward", FIELD_FLAG, 1, 1, 0},
                {"origin", FIELD_VALUE, 0, 3, 1},
                {"direction", FIELD_VALUE, 3, 3, 0},
                {"weight", FIELD_VALUE, 6, 1, 0},
            },
        [EVENT_HIT] =
            {
                {"meets", FIELD_OBJECT, 0, 1, 0},
                {"from_inside", FIELD_FLAG, 1, 1, 0},
                {"distance", FIELD_VALUE, 6, 1, 1},
                {"normal", FIELD_VALUE, 0, 3, 0},
                {"point", FIELD_VALUE, 3, 3, 1},
            },
        [EVENT_SPLIT] =
            {
                {"cos_in", FIELD_VALUE, 3, 1, 0},
                {"total_reflection", FIELD_FLAG, 0, 1, 0},
                {"k_r", FIELD_VALUE, 4, 1, 0},
                {"refracted", FIELD_VALUE, 0, 3, 0},
            },
        [EVENT_UNTRACED] =
            {
                {"why", FIELD_NUMBER, 0, 1, 0},
                {"weight", FIELD_VALUE, 0, 1, 0},
                {"charge", FIELD_VALUE, 1, 1, 0},
            },
        [EVENT_LIGHT] =
            {
                {"light", FIELD_NUMBER, 0, 1, 0},
                {"light_sample", FIELD_NUMBER, 1, 1, 0},
                {"light_point", FIELD_VALUE, 0, 3, 1},
                {"distance", FIELD_VALUE, 3, 1, 1},
                {"cos_in", FIELD_VALUE, 4, 1, 0},
                {"shines", FIELD_NUMBER, 2, 1, 0},
                {"shadow", FIELD_OBJECT, 3, 1, 0},
                {"received", FIELD_VALUE, 5, 1, -2},
                {"area", FIELD_VALUE, 6, 1, 2},
            },
        [EVENT_LEAF] =
            {
                {"sees", FIELD_VALUE, 0, 3, 0},
                {"adds", FIELD_VALUE, 3, 3, 0},
            },
        [EVENT_SAMPLE] =
            {
                {"sum", FIELD_VALUE, 0, 3, 0},
                {"charge", FIELD_VALUE, 6, 1, 0},
            },
        [EVENT_PIXEL] =
            {
                {"radiance", FIELD_VALUE, 0, 3, 0},
            },
};

const struct event_field *event_fields(int kind)
{
    return fields[kind];
}

const char *event_name(int kind)
{
    static const char *const names[EVENT_KINDS] = {"ray",   "hit",  "split",  "untraced",
                                                   "light", "leaf", "sample", "pixel"};
    return names[kind];
}

double event_value(const struct reference_event *event, const struct event_field *field, int component)
{
    const int facts[] = {event->head.facts.x, event->head.facts.y, event->head.facts.z, event->head.facts.w};
    return field->type == FIELD_VALUE ? event->values[field->first + component] : facts[field->first];
}

bool event_values_agree(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static bool same_place(const struct reference_event *a, const struct reference_event *b)
{
    return memcmp(&a->head.place, &b->head.place, sizeof a->head.place) == 0;
}

static struct event_difference compare_event(const struct reference_event *device,
                                             const struct reference_event *reference)
{
    struct event_difference difference = {.differs = !same_place(device, reference)};
    if (difference.differs)
        return difference;
    for (const struct event_field *field = event_fields(device->head.place.x); field->name; ++field)
        for (int c = 0; c < field->count; ++c)
            if (!event_values_agree(event_value(device, field, c), event_value(reference, field, c)))
                return (struct event_difference){.differs = true, .field = field, .component = c};
    return difference;
}

struct event_difference events_compare(const struct pixel_events *device,
                                       const struct pixel_events *reference)
{
    size_t both = device->count < reference->count ? device->count : reference->count;
    struct event_difference difference = {0};
    for (size_t i = 0; i < both && !difference.differs; ++i) {
        difference = compare_event(&device->events[i], &reference->events[i]);
        difference.event = i;
    }
    if (!difference.differs && device->count + device->beyond != reference->count + reference->beyond)
        difference = (struct event_difference){.differs = true, .event = both};
    return difference;
}
