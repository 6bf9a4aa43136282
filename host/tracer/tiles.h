#ifndef VKWHITTED_TRACER_TILES_H
#define VKWHITTED_TRACER_TILES_H

#include "base/progress.h"
#include "tracer/dispatch.h"
#include "tracer/values.h"

enum { FRAMES = 2 };

/* Renders pictures in tiles, of which two at most are under way. What it has learned of the device's speed
 * holds for the next picture. */
struct tracer {
    struct dispatcher dispatcher;
    struct dispatch_frame frames[FRAMES];
    unsigned frame_count, width, height; /* of the frames there are, and of their tiles at most */
    unsigned pixels;                     /* of a tile, at most */
    uint32_t turns;                      /* of a dispatch, at most */
};

/* As tracer_render(). */
enum status tiles_render(struct tracer *tracer, struct window window, const struct tracer_values *values,
                         struct progress *progress, struct tracer_times *times);

/* Destroys the frames there are. */
void tiles_destroy(struct tracer *tracer);

#endif
