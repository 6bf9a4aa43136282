#ifndef VKWHITTED_WATCH_VIEW_H
#define VKWHITTED_WATCH_VIEW_H

#include "watch/turn.h"

/* The motion of the camera in the window. */
struct watch_view {
    bool moving;
    double last_motion_ms;
    bool shows_difference;
    size_t differing; /* pixels, while it does */
};

/* Waits for input to the window, for a moment, and does what it asks for. While the camera moves, the picture
 * is as coarse as it must be to follow; it becomes fine again when the camera rests. *closed: the window is.
 */
enum status watch_view_follow(struct watch_view *view, struct watching *watching, bool *closed);

#endif
