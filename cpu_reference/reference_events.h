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

#endif
