#include "cmocka_test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "test_folder.h"
#include "test_window.h"

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

static void test_title(void **state)
{
    (void)state;
    assert_true(x11_window_title_has(&window, "vkwhitted"));
    display_set_title(display, "a title line");
    for (double start = clock_ms(); clock_ms() < start + patience_ms;) {
        if (x11_window_title_has(&window, "a title line"))
            return;
        wait_for_input(0.01);
    }
    fail_msg("the title is another");
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

int main(void)
{
    const struct CMUnitTest with_server[] = {
        cmocka_unit_test_setup_teardown(test_bytes, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_sizes, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_dragged_corner, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_hidden_and_minimised, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_uncovered, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_too_large, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_title, open_window, close_window),
    };
    const struct CMUnitTest without_server[] = {cmocka_unit_test(test_no_display)};
    int failures = cmocka_run_group_tests(with_server, open_server, close_server);
    return failures + cmocka_run_group_tests(without_server, NULL, NULL);
}
