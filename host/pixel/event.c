#include "pixel/event.h"

#include <math.h>
#include <string.h>

static const char *const untraced[MOST_EVENT_NAMES] = {
    [UNTRACED_REFLECTED] = "reflected ray not traced",
    [UNTRACED_REFRACTED] = "refracted ray not traced",
    [UNTRACED_BOUNCES] = "no further ray: max_bounces",
    [UNTRACED_ESCAPES] = "no further ray: escapes between mirrors",
};
static const char *const shines[MOST_EVENT_NAMES] = {
    [LIGHT_TOO_NEAR] = "too near to shine",
    [LIGHT_BEHIND] = "behind the surface",
    [LIGHT_SHADOW_RAY] = "shadow ray",
};

static const struct event_field fields[] = {
    {EVENT_RAY, "leaves", FIELD_OBJECT, 0, 1, .shown = SHOWN_IF_DIFFERENT},
    {EVENT_RAY, "inward", FIELD_FLAG, 1, 1, .shown = SHOWN_IF_DIFFERENT},
    {EVENT_RAY, "origin", FIELD_VALUE, 0, 3, .metres = 1},
    {EVENT_RAY, "direction", FIELD_VALUE, 3, 3, .shown = SHOWN},
    {EVENT_RAY, "weight", FIELD_VALUE, 6, 1, .shown = SHOWN},
    {EVENT_HIT, "meets", FIELD_OBJECT, 0, 1, .shown = SHOWN},
    {EVENT_HIT, "from_inside", FIELD_FLAG, 1, 1, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_HIT, "distance", FIELD_VALUE, 6, 1, .metres = 1, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_HIT, "normal", FIELD_VALUE, 0, 3, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_HIT, "point", FIELD_VALUE, 3, 3, .metres = 1, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_SPLIT, "cos_in", FIELD_VALUE, 3, 1, .shown = SHOWN},
    {EVENT_SPLIT, "total_reflection", FIELD_FLAG, 0, 1, .shown = SHOWN},
    {EVENT_SPLIT, "k_r", FIELD_VALUE, 4, 1, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_SPLIT, "refracted", FIELD_VALUE, 0, 3, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_UNTRACED, "why", FIELD_NUMBER, 0, 1, .shown = SHOWN_IF_DIFFERENT, .names = untraced},
    {EVENT_UNTRACED, "weight", FIELD_VALUE, 0, 1, .shown = SHOWN},
    {EVENT_UNTRACED, "charge", FIELD_VALUE, 1, 1, .not_analysed = true},
    {EVENT_LIGHT, "light", FIELD_NUMBER, 0, 1, .shown = SHOWN_IF_DIFFERENT},
    {EVENT_LIGHT, "light_sample", FIELD_NUMBER, 1, 1, .shown = SHOWN_IF_DIFFERENT},
    {EVENT_LIGHT, "light_point", FIELD_VALUE, 0, 3, .metres = 1},
    {EVENT_LIGHT, "distance", FIELD_VALUE, 3, 1, .metres = 1, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_LIGHT, "cos_in", FIELD_VALUE, 4, 1, .shown = SHOWN},
    {EVENT_LIGHT, "shines", FIELD_NUMBER, 2, 1, .names = shines},
    {EVENT_LIGHT, "shadow", FIELD_OBJECT, 3, 1, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_LIGHT, "received", FIELD_VALUE, 5, 1, .metres = -2, .shown = SHOWN_IF_FOLLOWED},
    {EVENT_LIGHT, "area", FIELD_VALUE, 6, 1, .metres = 2, .shown = SHOWN_OF_QUADS},
    {EVENT_LEAF, "sees", FIELD_VALUE, 0, 3, .shown = SHOWN},
    {EVENT_LEAF, "adds", FIELD_VALUE, 3, 3, .shown = SHOWN},
    {EVENT_SAMPLE, "sum", FIELD_VALUE, 0, 3, .shown = SHOWN},
    {EVENT_SAMPLE, "charge", FIELD_VALUE, 6, 1, .not_analysed = true},
    {EVENT_PIXEL, "radiance", FIELD_VALUE, 0, 3, .shown = SHOWN},
};

const struct event_field *event_next_field(const struct reference_event *event,
                                           const struct event_field *field)
{
    const struct event_field *end = fields + sizeof fields / sizeof *fields;
    field = field ? field + 1 : fields;
    while (field < end && field->kind != event->head.place.EVENT_KIND)
        ++field;
    return field < end ? field : NULL;
}

const char *event_name(const struct reference_event *event)
{
    static const char *const names[EVENT_KINDS] = {"ray",   "hit",  "split",  "untraced",
                                                   "light", "leaf", "sample", "pixel"};
    return names[event->head.place.EVENT_KIND];
}

bool event_is_followed(const struct reference_event *event)
{
    const layout_ivec4 facts = event->head.facts;
    switch (event->head.place.EVENT_KIND) {
    case EVENT_HIT:
        return facts.EVENT_SURFACE >= 0;
    case EVENT_SPLIT:
        return !facts.EVENT_TOTAL;
    case EVENT_LIGHT:
        return facts.EVENT_LIGHT_STATE == LIGHT_SHADOW_RAY;
    default:
        return true;
    }
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

bool event_field_agrees(const struct event_field *field, const struct reference_event *a,
                        const struct reference_event *b, int *component)
{
    for (int c = 0; c < field->count; ++c)
        if (!event_values_agree(event_value(a, field, c), event_value(b, field, c))) {
            if (component)
                *component = c;
            return false;
        }
    return true;
}

struct event_difference ray_trees_compare(const struct ray_tree *device, const struct ray_tree *reference)
{
    size_t i = 0;
    for (; i < device->count && i < reference->count; ++i) {
        const struct reference_event *a = &device->events[i], *b = &reference->events[i];
        if (memcmp(&a->head.place, &b->head.place, sizeof a->head.place) != 0)
            return (struct event_difference){.differs = true, .event = i};
        int component;
        for (const struct event_field *field = NULL; (field = event_next_field(a, field));)
            if (!event_field_agrees(field, a, b, &component))
                return (struct event_difference){true, i, field, component};
    }
    return (struct event_difference){
        .differs = device->count + device->beyond != reference->count + reference->beyond, .event = i};
}
