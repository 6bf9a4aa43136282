#ifndef VKWHITTED_TRACER_TILES_H
#define VKWHITTED_TRACER_TILES_H

#include "base/progress.h"
#include "tracer/dispatch.h"
#include "tracer/values.h"

enum { FRAMES = 2 };

/* A picture's way through the device, in tiles of which two at most are under way. What has been learned of
 * the device's speed holds for the next picture. */
struct tiles {
    const struct dispatcher *dispatcher;
    struct dispatch_frame frames[FRAMES];
    unsigned frame_count, width, height; /* of the frames there are, and of their tiles at most */
    unsigned pixels;                     /* of a tile, at most */
    uint32_t turns;                      /* of a dispatch, at most */
};

/* Makes it without frames, for a dispatcher that outlives it. */
void tiles_create(const struct dispatcher *dispatcher, struct tiles *tiles);
void tiles_destroy(struct tiles *tiles);

/* As tracer_render_values(). */
enum status tiles_render(struct tiles *tiles, struct window window, const struct tracer_values *values,
                         struct progress *progress, struct tracer_times *times);

#endif
