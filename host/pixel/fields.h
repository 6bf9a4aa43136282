#ifndef VKWHITTED_PIXEL_FIELDS_H
#define VKWHITTED_PIXEL_FIELDS_H

#include <stdbool.h>

#include "pixel/events.h"

/* What the facts and values of an event are: its quantities, in the order in which they are computed. */
enum event_field_type {
    FIELD_VALUE,
    FIELD_FLAG,
    FIELD_OBJECT, /* number of a surface, or -1 */
    FIELD_NUMBER,
};

struct event_field {
    const char *name; /* NULL ends the list */
    enum event_field_type type;
    int first, count; /* of the values or facts */
    int metres;       /* power of a length that the values are */
};

const struct event_field *event_fields(int kind);

/* What a kind of event is called. */
const char *event_name(int kind);

/* One of a field's facts or values. */
double event_value(const struct reference_event *event, const struct event_field *field, int component);

/* The same bits; a NaN is like any other. */
bool event_values_agree(double a, double b);

/* Where two lists of events part. */
struct event_difference {
    bool differs;
    size_t event;
    const struct event_field
        *field; /* NULL: another kind of event, or of another ray, or one side has ended */
    int component;
};

struct event_difference events_compare(const struct pixel_events *device,
                                       const struct pixel_events *reference);

#endif
