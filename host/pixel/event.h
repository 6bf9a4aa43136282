#ifndef VKWHITTED_PIXEL_EVENT_H
#define VKWHITTED_PIXEL_EVENT_H

#include <stdbool.h>

#include "pixel/ray_tree.h"

/* What the facts and values of an event are: its quantities, in the order in which they are computed. */
enum event_field_type {
    FIELD_VALUE,
    FIELD_FLAG,
    FIELD_OBJECT, /* number of a surface, or -1 */
    FIELD_NUMBER,
};

/* Where a quantity is shown; where the sides differ in it, it always is. */
enum event_field_shown {
    SHOWN,
    SHOWN_IF_DIFFERENT,
    SHOWN_IF_FOLLOWED, /* by something that it is needed for, see event_is_followed() */
    SHOWN_OF_QUADS,    /* so too, and the light is a quad */
};

enum { MOST_EVENT_NAMES = 4 };

struct event_field {
    int kind; /* of event */
    const char *name;
    enum event_field_type type;
    int first, count; /* of the values or facts */
    int metres;       /* power of a length that the values are */
    enum event_field_shown shown;
    const char *const *names; /* MOST_EVENT_NAMES, for what FIELD_NUMBER stands for; NULL: for itself */
    bool not_analysed;        /* by the tracers of higher precision */
};

/* The field of the event that follows this one, or its first for NULL; NULL where there is no other. */
const struct event_field *event_next_field(const struct reference_event *event,
                                           const struct event_field *field);

/* What the event's kind is called. */
const char *event_name(const struct reference_event *event);

/* The ray has met something, is refracted, or looks for what stands before a light. */
bool event_is_followed(const struct reference_event *event);

/* One of a field's facts or values. */
double event_value(const struct reference_event *event, const struct event_field *field, int component);

/* The same bits; a NaN is like any other. */
bool event_values_agree(double a, double b);

/* Whether a field has the same values in both; in *component, if not NULL, the first that differs. */
bool event_field_agrees(const struct event_field *field, const struct reference_event *a,
                        const struct reference_event *b, int *component);

/* Where two ray trees part. */
struct event_difference {
    bool differs;
    size_t event;
    const struct event_field
        *field; /* NULL: another kind of event, or of another ray, or one side has ended */
    int component;
};

struct event_difference ray_trees_compare(const struct ray_tree *device, const struct ray_tree *reference);

#endif
