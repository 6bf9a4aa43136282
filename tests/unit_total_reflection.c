/* Total internal reflection: tests/scenes/total_reflection.yaml has a closed form, pixel by pixel. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>

#include "test_render.h"

/* The sine of the angle of incidence at the ball's inside for pixel (x, y): the ray's distance from the
 * centre. The camera is at (0.9, 0, 0) looking along +z, so +x is on the left. */
static double sine_of_incidence(unsigned x, unsigned y)
{
    double half_height = tan(50 * 3.14159265358979323846 / 180);
    double d[3] = {-(x + 0.5 - 120) / 80 * half_height, -(y + 0.5 - 80) / 80 * half_height, 1};
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return 0.9 * sqrt(d[1] * d[1] + d[2] * d[2]) / length; /* |(0.9, 0, 0) x d| */
}

/* Fresnel's k_r inside glass of index 1.5, below the critical angle, as the textbook has it. */
static double fresnel(double sine)
{
    double cos_in = sqrt(1 - sine * sine), cos_out = sqrt(1 - 2.25 * sine * sine);
    double r_s = (1.5 * cos_in - cos_out) / (1.5 * cos_in + cos_out);
    double r_p = (cos_in - 1.5 * cos_out) / (cos_in + 1.5 * cos_out);
    return (r_s * r_s + r_p * r_p) / 2;
}

/* What is left of the background after 5 hits. */
static double part_let_out(double sine)
{
    return 1 - pow(fresnel(sine), 5);
}

/* Float's 2^-24 in each of the dozen operations that make a direction and a normal, over 5 hits. */
static const double sine_error = 2e-6;

static void check_picture(const struct rendering *rendering, const char *renderer)
{
    uint64_t total = 0, critical = 0;
    for (unsigned y = 0; y < 160; ++y)
        for (unsigned x = 0; x < 240; ++x) {
            const float *rgb = rendering->image.rgb + ((size_t)y * 240 + x) * 3;
            double sine = sine_of_incidence(x, y);
            bool totally = 1.5 * sine > 1;
            total += totally;
            critical += fabs(1.5 * sine - 1) < 1.5 * sine_error;
            double expected = totally ? 0 : part_let_out(sine);
            double bound = totally ? 0 : 1e-6 + fabs(part_let_out(sine - sine_error) - expected);
            for (int c = 0; c < 3; ++c) {
                double background = c == 0 ? 1 : c == 1 ? 0.5 : 0.25;
                if (fabs((double)rgb[c] - background * expected) <= bound)
                    continue;
                print_error("%s: pixel (%u, %u) channel %d: %.9g, expected %.9g\n", renderer, x, y, c,
                            (double)rgb[c], background * expected);
                fail();
            }
        }
    /* A totally reflected ray goes on alone through all 5 bounces, any other is split at each of 5 hits. */
    assert_true(total > 240 * 160 / 4);
    assert_int_equal(critical, 0);
    assert_int_equal(rendering->rays.primary, 240 * 160);
    assert_int_equal(rendering->rays.secondary, 5 * total + 10 * (240 * 160 - total));
    assert_int_equal(rendering->rays.shadow, 0);
}

static void closed_form(void **state)
{
    (void)state;
    struct scene scene = test_read("tests/scenes/total_reflection.yaml");
    for (int renderer = 0; renderer < TEST_RENDERERS; ++renderer) {
        struct rendering rendering =
            test_render_scene(&scene, (enum test_renderer)renderer, (struct window){0});
        check_picture(&rendering, test_renderer_names[renderer]);
        image_destroy(&rendering.image);
    }
    scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(closed_form)};
    return cmocka_run_group_tests(tests, test_open_device, test_close_device);
}
