#ifndef VKWHITTED_WATCH_DISPLAY_H
#define VKWHITTED_WATCH_DISPLAY_H

#include "base/status.h"

/* A window that shows a picture by OpenGL, which scales it as windows come and go in size, and takes input;
 * by GLFW, on the main thread. */
struct display;

/* Opens the connection to the window system. STATUS_UNABLE (reported) where there is no display. One that
 * goes away later ends the program, as libraries have it. */
enum status display_connect(void);
void display_disconnect(void);

/* What the user has asked for since the last time. Dragged distances are in heights of the shown picture,
 * x to the right and y down, as camera_motion.h has them; zoom is in its steps, positive: nearer. */
struct display_input {
    bool closed;                                /* the window's button, or Escape */
    double orbit_x, orbit_y;                    /* dragging */
    double pan_x, pan_y;                        /* the same with Shift */
    double zoom;                                /* wheel */
    bool reset, print_camera, save, difference; /* R, P, S, D */
};

/* Opens a window of this size. On failure (reported) *display is NULL. */
enum status display_create(unsigned width, unsigned height, struct display **display);
void display_destroy(struct display **display);

/* Where the next picture goes, in place of the last one: 8-bit sRGB values as RGB, row 0 on top. The
 * memory stays the display's. NULL (reported) without memory, or where no window shows
 * one as large as that. */
unsigned char *display_picture(struct display *display, unsigned width, unsigned height);

/* Shows it in the window as large as that is now: scaled to fit, its aspect kept, the rest black. In its own
 * size the bytes shown are the bytes given; enlarged, they are those of the nearest pixel; reduced, between
 * those of the four nearest. display_wait() does so again wherever the window needs it. STATUS_UNABLE
 * (reported): nothing will be shown any more. */
enum status display_paint(struct display *display);

/* Waits until something happens to the window, but no longer than for so many seconds. */
enum status display_wait(struct display *display, double seconds, struct display_input *input);

struct extent {
    unsigned width, height;
};

struct area {
    unsigned x, y, width, height;
};

/* Where a picture fits in a window; at least one pixel, unless the window is empty. */
struct area fit_picture(struct extent picture, struct extent window);

/* UTF-8. */
void display_set_title(struct display *display, const char *title);

#endif
