/* Light samples earn their time: the error falls faster than independent points could make it. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/statistics.h"
#include "test_render.h"

enum { WIDTH = 30, HEIGHT = 20, VALUES = WIDTH * HEIGHT * 3, DRAWN = 64 };

/* Figure 2b, 3 values a pixel; the caller frees them. */
static double *render(enum precision precision, unsigned light_samples)
{
    struct scene scene = test_read("scenes/figure_2b.yaml");
    struct picture_settings settings = test_settings(&scene);
    settings.width = WIDTH;
    settings.height = HEIGHT;
    settings.light_samples = light_samples;
    struct packed_scene packed = test_pack(&scene, settings);
    struct rendering rendering =
        test_render(&packed, precision == PRECISION_DOUBLE ? TEST_DOUBLE : TEST_FLOAT, (struct window){0});
    double *values = malloc(VALUES * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < VALUES; ++i)
        values[i] = precision == PRECISION_DOUBLE ? rendering.image.rgb64[i] : (double)rendering.image.rgb[i];
    image_destroy(&rendering.image);
    pack_destroy(&packed);
    scene_destroy(&scene);
    return values;
}

static double *truth;

static int find_truth(void **state)
{
    (void)state;
    truth = render(PRECISION_DOUBLE, 65536);
    return 0;
}

static int free_truth(void **state)
{
    (void)state;
    free(truth);
    return 0;
}

static double rmse(unsigned light_samples)
{
    double *values = render(PRECISION_FLOAT, light_samples), sum = 0;
    for (size_t i = 0; i < VALUES; ++i)
        sum += (values[i] - truth[i]) * (values[i] - truth[i]);
    free(values);
    return sqrt(sum / VALUES);
}

static void error_falls_as_a_power(void **state)
{
    (void)state;
    double samples[7], errors[7];
    for (int i = 0; i < 7; ++i) {
        samples[i] = 4 << i;
        errors[i] = rmse(4U << i);
        print_message("%g light samples: RMSE %.3g\n", samples[i], errors[i]);
    }
    double slope = log_log_slope(samples, errors, 7);
    print_message("slope %.3f\n", slope);
    assert_true(slope <= -0.7);
}

/* The mean square error of n independent points is the variance of one point by n. Point k of a pixel is what
 * k + 1 light samples have on top of k. */
static void error_is_below_that_of_independent_points(void **state)
{
    (void)state;
    double *before = calloc(VALUES, sizeof *before), variance = 0;
    assert_non_null(before);
    for (unsigned k = 0; k < DRAWN; ++k) {
        double *mean = render(PRECISION_DOUBLE, k + 1);
        for (size_t i = 0; i < VALUES; ++i) {
            double sum = (k + 1) * mean[i], deviation = sum - before[i] - truth[i];
            variance += deviation * deviation / DRAWN / VALUES;
            before[i] = sum;
        }
        free(mean);
    }
    free(before);
    double independent = sqrt(variance / 32), ours = rmse(32);
    print_message("RMSE of 32 light samples: %.3g, of independent points %.3g\n", ours, independent);
    assert_true(ours <= independent / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_falls_as_a_power),
        cmocka_unit_test(error_is_below_that_of_independent_points),
    };
    return cmocka_run_group_tests(tests, find_truth, free_truth);
}
