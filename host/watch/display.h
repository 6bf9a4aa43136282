#ifndef VKWHITTED_WATCH_DISPLAY_H
#define VKWHITTED_WATCH_DISPLAY_H

#include "vulkan/context.h"

/* A window that shows a picture and takes input, by GLFW, on the main thread. */
struct display;

/* Opens the connection to the window system, and asks for a Vulkan context that shows pictures there.
 * STATUS_UNABLE (reported) where there is no display. One that goes away later ends the program, as libraries
 * have it. */
enum status display_connect(struct vulkan_options *vulkan);
void display_disconnect(void);

/* What the user has asked for since the last time. Dragged distances are in heights of the shown picture,
 * x to the right and y down, as camera_motion.h has them; zoom is in its steps, positive: nearer. */
struct display_input {
    bool closed;                                /* the window's button, or Escape */
    double orbit_x, orbit_y;                    /* dragging, arrows */
    double pan_x, pan_y;                        /* the same with Shift */
    double zoom;                                /* wheel, + and - */
    bool reset, print_camera, save, difference; /* R, P, S, D */
};

/* Opens a window of this size on a context that presents and outlives it. On failure (reported) *display is
 * NULL. */
enum status display_create(struct vulkan_context *context, unsigned width, unsigned height,
                           struct display **display);
void display_destroy(struct display **display);

/* Where the next picture goes, in place of the last one: 8-bit sRGB values as RGBA, row 0 on top, what A is
 * does not matter. The memory stays the display's. NULL (reported) without memory, or where the device shows
 * none as large as that. */
unsigned char *display_picture(struct display *display, unsigned width, unsigned height);

/* Shows it as swapchain_show() does; display_wait() does so again wherever the window needs it. Both use the
 * context's queue. STATUS_UNABLE (reported): nothing will be shown any more. */
enum status display_paint(struct display *display);

/* Waits until there is input, or a signal came, or the time is over. */
enum status display_wait(struct display *display, double seconds, struct display_input *input);

/* UTF-8. */
void display_set_title(struct display *display, const char *title);

#endif
