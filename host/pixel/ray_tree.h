#ifndef VKWHITTED_PIXEL_RAY_TREE_H
#define VKWHITTED_PIXEL_RAY_TREE_H

#include "reference.h"
#include "tracer/render.h"

/* The ray tree of a pixel as one side tells it: its events, in the order of the recursion. */
struct ray_tree {
    struct reference_event *events;
    size_t count;
    size_t beyond; /* more took place, and are not here */
};

/* Traces the first pixel of plan->window in the plan's precision, with the picture's own pipeline but for the
 * recording; so many events are expected. The caller frees the tree with ray_tree_destroy(). On failure
 * (reported) it is empty. */
enum status ray_tree_on_device(struct vulkan_context *context, const struct render_plan *plan,
                               size_t expected, struct ray_tree *tree);

/* The same with the reference (against: PRECISION_FLOAT), or the error analysis at higher precision. */
enum status ray_tree_on_cpu(const struct render_plan *plan, enum precision against, struct ray_tree *tree);

void ray_tree_destroy(struct ray_tree *tree);

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

/* The first component in which a field's values differ; -1 where none does. */
int event_field_difference(const struct event_field *field, const struct reference_event *a,
                           const struct reference_event *b);

/* Where two ray trees part. */
struct event_difference {
    bool differs;
    size_t event;
    const struct event_field
        *field; /* NULL: other kinds of events, or of other rays, or one side has ended */
    int component;
};

struct event_difference ray_trees_compare(const struct ray_tree *device, const struct ray_tree *reference);

#endif
