#ifndef VKWHITTED_REFERENCE_EVENTS_H
#define VKWHITTED_REFERENCE_EVENTS_H

#include <stddef.h>

#include "packed_scene.h"

/* One step of a pixel's ray tree; scene_layout.h says what the kinds hold. Lengths are in scene units. */
struct reference_event {
    struct EventHead head;
    double values[EVENT_VALUES];
    double bounds[EVENT_VALUES]; /* on float's error in each value; the analysis alone knows it */
    double margin; /* of the decisions made here, as in margin.h; INFINITY where there are none */
};

/* Events in the order of the recursion. Those beyond the room are counted and not kept. */
struct reference_log {
    struct reference_event *events;
    size_t room, count;
};

/* Traces the pixel as the functions of reference.h do, and appends what happens to the log. */
void reference_record_float(const struct packed_scene *scene, int x, int y, struct reference_log *log);
void reference_record_double(const struct packed_scene *scene, int x, int y, struct reference_log *log);

/* The same at high precision, with bounds and margins; no EVENT_SAMPLE, and no charges. */
void reference_analyse_double(const struct packed_scene *scene, int x, int y, struct reference_log *log);
void reference_analyse_quad(const struct packed_scene *scene, int x, int y, struct reference_log *log);

#endif
