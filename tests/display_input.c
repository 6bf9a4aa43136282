#include "cmocka_test.h"

#include <math.h>

#include "base/clock.h"
#include "test_window.h"

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
        {XK_Escape, 0, {.closed = true}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        x11_window_key(&window, XK_x, 0);
        x11_window_key(&window, XK_p, ControlMask);
        x11_window_key(&window, cases[i].symbol, cases[i].modifiers);
        struct display_input input = gather_input();
        assert_input(&input, &cases[i].input);
    }
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_keys, open_window, close_window),
        cmocka_unit_test_setup_teardown(test_pointer, open_window, close_window),
    };
    return cmocka_run_group_tests(tests, open_server, close_server);
}
