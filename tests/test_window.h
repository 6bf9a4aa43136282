#ifndef VKWHITTED_TEST_WINDOW_H
#define VKWHITTED_TEST_WINDOW_H

#include <stdint.h>
#include <stdlib.h>

#include "base/clock.h"
#include "watch/display.h"
#include "watch/fit.h"
#include "watch/window_system.h"
#include "x11_window.h"
#include "xvfb.h"

/* A window on an X server of the test's own, with the validation layer watching throughout. Include after
 * cmocka.h. */

enum { WIDTH = 320, HEIGHT = 200 };
static const double patience_ms = 30000; /* more than a loaded machine takes */

static pid_t server;
static struct vulkan_context *context;
static struct display *display;
static struct x11_window window;
static unsigned char rgba[WIDTH * HEIGHT * 4];
static const struct rgba_picture picture = {WIDTH, HEIGHT, rgba};

static inline void draw_noise(uint32_t seed)
{
    for (size_t i = 0; i < sizeof rgba; ++i) {
        seed = seed * 1664525 + 1013904223;
        rgba[i] = (unsigned char)(seed >> 24);
    }
}

static inline int open_context(void **state)
{
    (void)state;
    server = xvfb_start();
    struct vulkan_options options = {.validate = true};
    return server > 0 && window_system_open(&options) == STATUS_DONE &&
                   vulkan_context_create(&options, &context) == STATUS_DONE
               ? 0
               : -1;
}

static inline int close_context(void **state)
{
    (void)state;
    enum status status = vulkan_context_destroy(&context);
    window_system_close();
    xvfb_kill(server);
    return status == STATUS_DONE ? 0 : -1;
}

/* A window of the picture's size that shows it. */
static inline int open_window(void **state)
{
    (void)state;
    draw_noise(1);
    return display_create(context, WIDTH, HEIGHT, &display) == STATUS_DONE && x11_window_find(&window) &&
                   display_show(display, rgba, WIDTH, HEIGHT) == STATUS_DONE
               ? 0
               : -1;
}

static inline int close_window(void **state)
{
    (void)state;
    XCloseDisplay(window.server);
    display_destroy(&display);
    return 0;
}

static inline struct display_input wait_for_input(double seconds)
{
    struct display_input input;
    assert_int_equal(display_wait(display, seconds, &input), STATUS_DONE);
    return input;
}

/* The number of pixels that are not as they should be; all of them where the size is another. */
static inline size_t count_wrong_pixels(unsigned width, unsigned height)
{
    size_t count = (size_t)width * height, wrong = 0;
    XImage *image = x11_window_pixels(&window);
    if (!image)
        return count;
    unsigned char *expected = malloc(4 * count);
    assert_non_null(expected);
    fit_draw(&picture, width, height, true, expected);
    if ((unsigned)image->width == width && (unsigned)image->height == height) {
        for (size_t i = 0; i < count; ++i)
            wrong += memcmp(image->data + 4 * i, expected + 4 * i, 3) != 0;
    } else {
        wrong = count;
    }
    free(expected);
    XDestroyImage(image);
    return wrong;
}

/* In the end the window is of this size and shows the picture, with nothing but display_wait() called. */
static inline void assert_shows(unsigned width, unsigned height)
{
    double start = clock_ms();
    size_t wrong;
    while ((wrong = count_wrong_pixels(width, height)) > 0 && clock_ms() < start + patience_ms)
        wait_for_input(0.02);
    if (wrong > 0)
        fail_msg("%zu of %u x %u pixels are wrong", wrong, width, height);
}

#endif
