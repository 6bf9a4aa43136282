#ifndef VKWHITTED_TEST_WINDOW_H
#define VKWHITTED_TEST_WINDOW_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/clock.h"
#include "watch/display.h"
#include "watch/swapchain.h"
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
    return server > 0 && display_connect(&options) == STATUS_DONE &&
                   vulkan_context_create(&options, &context) == STATUS_DONE
               ? 0
               : -1;
}

static inline int close_context(void **state)
{
    (void)state;
    enum status status = vulkan_context_destroy(&context);
    display_disconnect();
    xvfb_kill(server);
    return status == STATUS_DONE ? 0 : -1;
}

static inline enum status show_picture(void)
{
    unsigned char *picture = display_picture(display, WIDTH, HEIGHT);
    if (!picture)
        return STATUS_UNABLE;
    memcpy(picture, rgba, sizeof rgba);
    return display_paint(display);
}

/* A window of the picture's size that shows it. */
static inline int open_window(void **state)
{
    (void)state;
    draw_noise(1);
    return display_create(context, WIDTH, HEIGHT, &display) == STATUS_DONE && x11_window_find(&window) &&
                   show_picture() == STATUS_DONE
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

/* Where along the picture's width or height, in pixels, the middle of pixel i of count shows it. */
static inline double source_of(unsigned i, unsigned count, unsigned source_count)
{
    return (i + 0.5) * source_count / count;
}

static inline double source_pixel(int x, int y, int channel)
{
    x = x < 0 ? 0 : x >= WIDTH ? WIDTH - 1 : x;
    y = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    return rgba[4 * (y * WIDTH + x) + channel];
}

/* Whether the value is that of the pixel at (x, y), on an edge that of either side. */
static inline bool is_nearest(double x, double y, int channel, double value)
{
    const double slack = 1e-3;
    for (int i = 0; i < 4; ++i)
        if (value == source_pixel((int)floor(x + (i & 1 ? slack : -slack)),
                                  (int)floor(y + (i & 2 ? slack : -slack)), channel))
            return true;
    return false;
}

/* Whether it is the mean of the four pixels around (x, y), as near as eight bits of weight give it. */
static inline bool is_between(double x, double y, int channel, double value)
{
    int left = (int)floor(x - 0.5), top = (int)floor(y - 0.5);
    double to_right = x - 0.5 - left, down = y - 0.5 - top;
    double mean = (1 - down) * ((1 - to_right) * source_pixel(left, top, channel) +
                                to_right * source_pixel(left + 1, top, channel)) +
                  down * ((1 - to_right) * source_pixel(left, top + 1, channel) +
                          to_right * source_pixel(left + 1, top + 1, channel));
    return fabs(value - mean) <= 3;
}

static inline bool is_right(unsigned x, unsigned y, VkRect2D fit, const unsigned char *bgr)
{
    unsigned across = x - (unsigned)fit.offset.x, down = y - (unsigned)fit.offset.y;
    bool inside = across < fit.extent.width && down < fit.extent.height;
    bool enlarged = fit.extent.width >= WIDTH && fit.extent.height >= HEIGHT;
    double source_x = source_of(across, fit.extent.width, WIDTH),
           source_y = source_of(down, fit.extent.height, HEIGHT);
    bool right = true;
    for (int channel = 0; channel < 3; ++channel) {
        double value = bgr[2 - channel];
        right = right && (!inside    ? value == 0
                          : enlarged ? is_nearest(source_x, source_y, channel, value)
                                     : is_between(source_x, source_y, channel, value));
    }
    return right;
}

/* The number of pixels that are not as they should be; all of them where the size is another. */
static inline size_t count_wrong_pixels(unsigned width, unsigned height)
{
    size_t count = (size_t)width * height, wrong = 0;
    const VkRect2D fit = fit_picture((VkExtent2D){WIDTH, HEIGHT}, (VkExtent2D){width, height});
    XImage *image = x11_window_pixels(&window);
    if (!image)
        return count;
    bool same_size = (unsigned)image->width == width && (unsigned)image->height == height;
    for (size_t i = 0; i < count && same_size; ++i)
        wrong += !is_right((unsigned)(i % width), (unsigned)(i / width), fit,
                           (const unsigned char *)image->data + 4 * i);
    XDestroyImage(image);
    return same_size ? wrong : count;
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
