#ifndef VKWHITTED_X11_WINDOW_H
#define VKWHITTED_X11_WINDOW_H

#include <stdbool.h>
#include <string.h>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

/* The window as another client sees it: its pixels, and what a user or a window manager does to it. Needs no
 * window manager. */
struct x11_window {
    Display *server;
    Window id;
};

/* The display's only top-level window with a name. */
static inline bool x11_window_find(struct x11_window *window)
{
    Window root, parent, *children;
    unsigned count = 0;
    char *name;
    window->server = XOpenDisplay(NULL);
    window->id = None;
    if (!window->server ||
        !XQueryTree(window->server, DefaultRootWindow(window->server), &root, &parent, &children, &count))
        return false;
    for (unsigned i = 0; i < count; ++i) {
        if (XFetchName(window->server, children[i], &name)) {
            window->id = children[i];
            XFree(name);
        }
    }
    if (children)
        XFree(children);
    return window->id != None;
}

static inline XWindowAttributes x11_window_attributes(const struct x11_window *window)
{
    XWindowAttributes attributes;
    XSync(window->server, False);
    XGetWindowAttributes(window->server, window->id, &attributes);
    return attributes;
}

/* Pixel i of the window, four bytes each: blue, green, red, unused. To be freed with XDestroyImage(). */
static inline XImage *x11_window_pixels(const struct x11_window *window)
{
    XWindowAttributes attributes = x11_window_attributes(window);
    if (attributes.map_state != IsViewable)
        return NULL;
    XImage *image = XGetImage(window->server, window->id, 0, 0, (unsigned)attributes.width,
                              (unsigned)attributes.height, AllPlanes, ZPixmap);
    if (image && (image->bits_per_pixel != 32 || image->byte_order != LSBFirst ||
                  image->bytes_per_line != 4 * image->width || image->red_mask != 0xff0000)) {
        XDestroyImage(image);
        return NULL;
    }
    return image;
}

static inline void x11_window_resize(const struct x11_window *window, unsigned width, unsigned height)
{
    XResizeWindow(window->server, window->id, width, height);
    XSync(window->server, False);
}

/* What a window manager does with a window that is minimised, and with one that is brought back. */
static inline void x11_window_minimise(const struct x11_window *window, bool minimised)
{
    Atom property = XInternAtom(window->server, "WM_STATE", False);
    const long state[2] = {minimised ? IconicState : NormalState, None};
    XChangeProperty(window->server, window->id, property, property, 32, PropModeReplace,
                    (const unsigned char *)state, 2);
    if (minimised)
        XUnmapWindow(window->server, window->id);
    else
        XMapWindow(window->server, window->id);
    XSync(window->server, False);
}

static inline void x11_window_key(const struct x11_window *window, KeySym symbol, unsigned modifiers)
{
    XEvent event = {.xkey = {
                        .type = KeyPress,
                        .display = window->server,
                        .window = window->id,
                        .root = DefaultRootWindow(window->server),
                        .state = modifiers,
                        .keycode = XKeysymToKeycode(window->server, symbol),
                        .same_screen = True,
                    }};
    static Time time; /* GLFW takes two presses at the same time for one */
    event.xkey.time = time += 100;
    XSendEvent(window->server, window->id, False, KeyPressMask, &event);
    event.type = KeyRelease;
    event.xkey.time = time += 100;
    XSendEvent(window->server, window->id, False, KeyReleaseMask, &event);
    XSync(window->server, False);
}

static inline void x11_window_button(const struct x11_window *window, unsigned button, bool pressed,
                                     unsigned modifiers)
{
    XEvent event = {.xbutton = {
                        .type = pressed ? ButtonPress : ButtonRelease,
                        .display = window->server,
                        .window = window->id,
                        .root = DefaultRootWindow(window->server),
                        .state = modifiers,
                        .button = button,
                        .same_screen = True,
                    }};
    XSendEvent(window->server, window->id, False, pressed ? ButtonPressMask : ButtonReleaseMask, &event);
    XSync(window->server, False);
}

static inline void x11_window_move_pointer(const struct x11_window *window, int x, int y)
{
    XWarpPointer(window->server, None, window->id, 0, 0, 0, 0, x, y);
    XSync(window->server, False);
}

/* The window's own button. */
static inline void x11_window_close(const struct x11_window *window)
{
    XEvent event = {.xclient = {
                        .type = ClientMessage,
                        .window = window->id,
                        .message_type = XInternAtom(window->server, "WM_PROTOCOLS", False),
                        .format = 32,
                    }};
    event.xclient.data.l[0] = (long)XInternAtom(window->server, "WM_DELETE_WINDOW", False);
    XSendEvent(window->server, window->id, False, NoEventMask, &event);
    XSync(window->server, False);
}

#endif
