/* The window on an X server of the test's own: what it shows, and what it takes. */
#include "cmocka_test.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "test_folder.h"
#include "watch/display.h"
#include "x11_window.h"
#include "xvfb.h"

enum { WIDTH = 320, HEIGHT = 200 };
static const double patience_ms = 30000; /* more than a loaded machine takes */

static pid_t server;
static struct display *display;
static struct x11_window window;
static unsigned char rgb[WIDTH * HEIGHT * 3];

static void draw_noise(uint32_t seed)
{
    for (size_t i = 0; i < sizeof rgb; ++i) {
        seed = seed * 1664525 + 1013904223;
        rgb[i] = (unsigned char)(seed >> 24);
    }
}

static int open_server(void **state)
{
    (void)state;
    server = xvfb_start();
    return server > 0 && display_connect() == STATUS_DONE ? 0 : -1;
}

static int close_server(void **state)
{
    (void)state;
    display_disconnect();
    xvfb_kill(server);
    return 0;
}

static enum status show_picture(void)
{
    unsigned char *picture = display_picture(display, WIDTH, HEIGHT);
    if (!picture)
        return STATUS_UNABLE;
    memcpy(picture, rgb, sizeof rgb);
    return display_paint(display);
}

/* A window of the picture's size that shows it. */
static int open_window(void **state)
{
    (void)state;
    draw_noise(1);
    return display_create(WIDTH, HEIGHT, &display) == STATUS_DONE && x11_window_find(&window) &&
                   show_picture() == STATUS_DONE
               ? 0
               : -1;
}

static int close_window(void **state)
{
    (void)state;
    XCloseDisplay(window.server);
    display_destroy(&display);
    return 0;
}

static struct display_input wait_for_input(double seconds)
{
    struct display_input input;
    assert_int_equal(display_wait(display, seconds, &input), STATUS_DONE);
    return input;
}

/* Where along the picture's width or height, in pixels, the middle of pixel i of count shows it. */
static double source_of(unsigned i, unsigned count, unsigned source_count)
{
    return (i + 0.5) * source_count / count;
}

static double source_pixel(int x, int y, int channel)
{
    x = x < 0 ? 0 : x >= WIDTH ? WIDTH - 1 : x;
    y = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    return rgb[3 * (y * WIDTH + x) + channel];
}

/* Whether the value is that of the pixel at (x, y), on an edge that of either side. */
static bool is_nearest(double x, double y, int channel, double value)
{
    const double slack = 1e-3;
    for (int i = 0; i < 4; ++i)
        if (value == source_pixel((int)floor(x + (i & 1 ? slack : -slack)),
                                  (int)floor(y + (i & 2 ? slack : -slack)), channel))
            return true;
    return false;
}

/* Whether it is the mean of the four pixels around (x, y), as near as eight bits of weight give it. */
static bool is_between(double x, double y, int channel, double value)
{
    int left = (int)floor(x - 0.5), top = (int)floor(y - 0.5);
    double to_right = x - 0.5 - left, down = y - 0.5 - top;
    double mean = (1 - down) * ((1 - to_right) * source_pixel(left, top, channel) +
                                to_right * source_pixel(left + 1, top, channel)) +
                  down * ((1 - to_right) * source_pixel(left, top + 1, channel) +
                          to_right * source_pixel(left + 1, top + 1, channel));
    return fabs(value - mean) <= 3;
}

static bool is_right(unsigned x, unsigned y, struct area fit, const unsigned char *bgr)
{
    unsigned across = x - fit.x, down = y - fit.y;
    bool inside = across < fit.width && down < fit.height;
    bool enlarged = fit.width >= WIDTH && fit.height >= HEIGHT;
    double source_x = source_of(across, fit.width, WIDTH), source_y = source_of(down, fit.height, HEIGHT);
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
static size_t count_wrong_pixels(unsigned width, unsigned height)
{
    size_t count = (size_t)width * height, wrong = 0;
    const struct area fit = fit_picture((struct extent){WIDTH, HEIGHT}, (struct extent){width, height});
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
static void assert_shows(unsigned width, unsigned height)
{
    double start = clock_ms();
    size_t wrong;
    while ((wrong = count_wrong_pixels(width, height)) > 0 && clock_ms() < start + patience_ms)
        wait_for_input(0.02);
    if (wrong > 0)
        fail_msg("%zu of %u x %u pixels are wrong", wrong, width, height);
}

static void test_bytes(void **state)
{
    (void)state;
    assert_shows(WIDTH, HEIGHT);
    XImage *image = x11_window_pixels(&window);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; ++i)
        for (size_t channel = 0; channel < 3; ++channel)
            assert_int_equal((unsigned char)image->data[4 * i + 2 - channel], rgb[3 * i + channel]);
    XDestroyImage(image);
    draw_noise(2);
    assert_int_equal(show_picture(), STATUS_DONE);
    assert_shows(WIDTH, HEIGHT);
}

static void test_sizes(void **state)
{
    (void)state;
    static const unsigned sizes[][2] = {{500, 200}, {320, 301}, {640, 400}, {1, 1},     {3000, 2000},
                                        {1, 2000},  {3000, 1},  {1, 1},     {160, 100}, {WIDTH, HEIGHT}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        x11_window_resize(&window, sizes[i][0], sizes[i][1]);
        assert_shows(sizes[i][0], sizes[i][1]);
    }
}

static void *resize_on_and_on(void *user)
{
    (void)user;
    Display *connection = XOpenDisplay(NULL);
    uint32_t seed = 1;
    for (int i = 0; i < 300; ++i) {
        seed = seed * 1664525 + 1013904223;
        XResizeWindow(connection, window.id, 1 + (seed >> 16) % 400, 1 + (seed >> 8) % 300);
        XFlush(connection);
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    XResizeWindow(connection, window.id, WIDTH, HEIGHT);
    XCloseDisplay(connection);
    return NULL;
}

static void test_dragged_corner(void **state)
{
    (void)state;
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, resize_on_and_on, NULL), 0);
    for (double start = clock_ms(); clock_ms() < start + 500;) {
        assert_int_equal(show_picture(), STATUS_DONE);
        wait_for_input(0);
    }
    pthread_join(thread, NULL);
    assert_shows(WIDTH, HEIGHT);
}

static void test_hidden_and_minimised(void **state)
{
    (void)state;
    assert_shows(WIDTH, HEIGHT);
    for (int minimised = 0; minimised <= 1; ++minimised) {
        if (minimised)
            x11_window_minimise(&window, true);
        else
            XUnmapWindow(window.server, window.id);
        wait_for_input(0.1);
        assert_true(x11_window_attributes(&window).map_state != IsViewable);
        draw_noise(3 + (uint32_t)minimised);
        assert_int_equal(show_picture(), STATUS_DONE);
        x11_window_resize(&window, 200, 200);
        wait_for_input(0.1);
        if (minimised)
            x11_window_minimise(&window, false);
        else
            XMapWindow(window.server, window.id);
        assert_shows(200, 200);
    }
}

static void test_uncovered(void **state)
{
    (void)state;
    assert_shows(WIDTH, HEIGHT);
    Window cover =
        XCreateSimpleWindow(window.server, DefaultRootWindow(window.server), 0, 0, 1000, 1000, 0, 0, 0xff);
    XMapRaised(window.server, cover);
    wait_for_input(0.1);
    XDestroyWindow(window.server, cover);
    assert_shows(WIDTH, HEIGHT);
    XClearArea(window.server, window.id, 10, 10, 100, 100, True);
    assert_shows(WIDTH, HEIGHT);
}

/* Larger than any texture. */
static void test_too_large(void **state)
{
    (void)state;
    char line[256];
    test_messages_begin();
    unsigned char *place = display_picture(display, 1 << 20, 1);
    int lines = test_messages_end(line);
    assert_null(place);
    assert_int_equal(lines, 1);
    assert_non_null(strstr(line, "error: a window shows pictures of up to "));
    wait_for_input(0.01);
    assert_int_equal(show_picture(), STATUS_DONE);
    assert_shows(WIDTH, HEIGHT);
}

/* Adds up what comes before the R that is pressed now. */
static struct display_input gather_input(void)
{
    struct display_input sum = {0};
    bool complete = false;
    x11_window_key(&window, XK_r, 0);
    for (double start = clock_ms(); !complete && clock_ms() < start + patience_ms;) {
        struct display_input input = wait_for_input(1);
        sum.orbit_x += input.orbit_x;
        sum.orbit_y += input.orbit_y;
        sum.pan_x += input.pan_x;
        sum.pan_y += input.pan_y;
        sum.zoom += input.zoom;
        sum.closed = sum.closed || input.closed;
        sum.print_camera = sum.print_camera || input.print_camera;
        sum.save = sum.save || input.save;
        sum.difference = sum.difference != input.difference;
        complete = input.reset;
    }
    assert_true(complete);
    return sum;
}

static void assert_input(const struct display_input *input, const struct display_input *expected)
{
    const double numbers[][2] = {{input->orbit_x, expected->orbit_x},
                                 {input->orbit_y, expected->orbit_y},
                                 {input->pan_x, expected->pan_x},
                                 {input->pan_y, expected->pan_y},
                                 {input->zoom, expected->zoom}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i)
        if (!(fabs(numbers[i][0] - numbers[i][1]) < 1e-12))
            fail_msg("number %zu is %g instead of %g", i, numbers[i][0], numbers[i][1]);
    assert_int_equal(input->closed, expected->closed);
    assert_int_equal(input->print_camera, expected->print_camera);
    assert_int_equal(input->save, expected->save);
    assert_int_equal(input->difference, expected->difference);
}

static void test_keys(void **state)
{
    (void)state;
    static const struct {
        KeySym symbol;
        unsigned modifiers;
        struct display_input input;
    } cases[] = {
        {XK_P, LockMask, {.print_camera = true}},
        {XK_p, 0, {.print_camera = true}},
        {XK_s, 0, {.save = true}},
        {XK_d, 0, {.difference = true}},
        {XK_Escape, 0, {.closed = true}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        x11_window_key(&window, XK_x, 0);
        x11_window_key(&window, XK_s, ControlMask);
        x11_window_key(&window, cases[i].symbol, cases[i].modifiers);
        struct display_input input = gather_input();
        assert_input(&input, &cases[i].input);
    }
    x11_window_key(&window, XK_d, 0);
    x11_window_key(&window, XK_d, 0);
    struct display_input input = gather_input();
    assert_input(&input, &(struct display_input){0});
}

static void test_pointer(void **state)
{
    (void)state;
    x11_window_resize(&window, 400, 400); /* the picture is 250 high in it */
    assert_shows(400, 400);
    for (unsigned shift = 0; shift <= ShiftMask; shift += ShiftMask) {
        x11_window_move_pointer(&window, 100, 100);
        x11_window_button(&window, Button1, true, shift);
        x11_window_move_pointer(&window, 110, 95);
        x11_window_move_pointer(&window, 150, 350);
        x11_window_button(&window, Button1, false, 0);
        x11_window_move_pointer(&window, 0, 0);
        struct display_input input = gather_input();
        struct display_input expected = {.orbit_x = 50 / 250.0, .orbit_y = 250 / 250.0};
        if (shift)
            expected = (struct display_input){.pan_x = 50 / 250.0, .pan_y = 250 / 250.0};
        assert_input(&input, &expected);
    }
    x11_window_button(&window, Button4, true, 0);
    x11_window_button(&window, Button4, true, 0);
    x11_window_button(&window, Button5, true, 0);
    struct display_input input = gather_input();
    assert_input(&input, &(struct display_input){.zoom = 1});
    x11_window_close(&window);
    input = gather_input();
    assert_input(&input, &(struct display_input){.closed = true});
}

static void test_no_display(void **state)
{
    (void)state;
    static const char *const names[] = {"", ":4711"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        char line[256];
        setenv("DISPLAY", names[i], 1);
        test_messages_begin();
        enum status status = display_connect();
        test_messages_end(line);
        assert_int_equal(status, STATUS_UNABLE);
        assert_non_null(strstr(line, "error: cannot open a window: "));
    }
}

#define IN_WINDOW(test) cmocka_unit_test_setup_teardown(test, open_window, close_window)

int main(void)
{
    const struct CMUnitTest with_server[] = {
        IN_WINDOW(test_bytes),          IN_WINDOW(test_sizes),
        IN_WINDOW(test_dragged_corner), IN_WINDOW(test_hidden_and_minimised),
        IN_WINDOW(test_uncovered),      IN_WINDOW(test_too_large),
        IN_WINDOW(test_keys),           IN_WINDOW(test_pointer),
    };
    const struct CMUnitTest without_server[] = {cmocka_unit_test(test_no_display)};
    int failures = cmocka_run_group_tests(with_server, open_server, close_server);
    return failures + cmocka_run_group_tests(without_server, NULL, NULL);
}
