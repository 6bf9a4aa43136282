#ifndef VKWHITTED_WATCH_DISPLAY_H
#define VKWHITTED_WATCH_DISPLAY_H

#include "vulkan/context.h"

/* A window that shows a picture and takes input. All but display_wake() is for the main thread. */
struct display;

/* What the user has asked for since the last time. Dragged distances are in heights of the shown picture,
 * x to the right and y down, as camera_motion.h has them; zoom is in its steps, positive: nearer. */
struct display_input {
    bool closed; /* the window's button, or Escape */
    bool resized;
    double orbit_x, orbit_y;                    /* dragging, arrows */
    double pan_x, pan_y;                        /* the same with Shift */
    double zoom;                                /* wheel, + and - */
    bool reset, print_camera, save, difference; /* R, P, S, D */
};

/* Opens a window of this size on a context that presents and outlives it. On failure (reported) *display is
 * NULL. */
enum status display_create(struct vulkan_context *context, unsigned width, unsigned height,
                           struct display **display);

/* Shows a picture of 8-bit sRGB values (RGBA, row 0 on top), which is copied, in place of the last one:
 * scaled to fit the window, its aspect kept, with black bars. In a window as large as the picture the bytes
 * shown are the bytes given. Uses the context's queue, as does display_wait(). STATUS_UNABLE (reported): the
 * display has gone away or cannot show anything any more. */
enum status display_show(struct display *display, const unsigned char *rgba, unsigned width, unsigned height);

/* UTF-8. */
void display_set_title(struct display *display, const char *title);

/* Waits until there is input, display_wake() or a signal (progress.h) came, or the time is over. The picture
 * follows the window's size meanwhile. STATUS_UNABLE as for display_show(). */
enum status display_wait(struct display *display, double seconds, struct display_input *input);

/* Ends a running display_wait(), or the next one. For any thread, while there is a context that presents. */
void display_wake(void);

void display_destroy(struct display **display);

#endif
