/* What a bench concludes from its measurements. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/statistics.h"
#include "bench/document.h"
#include "failing_memory.h"
#include "test_folder.h"
#include "test_render.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g, expected %.17g", value, expected);
}

/* Points with these times and errors within which 99.9 % of the pixels are. */
static void make_points(const double *times, const double *errors, size_t count, struct bench_point *points)
{
    for (size_t i = 0; i < count; ++i)
        points[i] = (struct bench_point){.median_ms = times[i], .error.absolute_999 = errors[i]};
}

static void front_is_what_nothing_beats(void **state)
{
    (void)state;
    const double times[] = {1, 2, 3, 2, 5, 1, 0.5, 6}, errors[] = {9, 4, 4, 3, 1, 9, INFINITY, 5};
    const bool expected[] = {true, false, false, true, true, true, false, true};
    struct bench_point points[8];
    make_points(times, errors, 8, points);
    points[7].family = FAMILY_SAMPLES; /* has a truth of its own */
    bench_mark_pareto(points, 8);
    for (int i = 0; i < 8; ++i)
        assert_int_equal(points[i].pareto, expected[i]);
}

static void fastest_within_an_error(void **state)
{
    (void)state;
    const double times[] = {5, 3, 4, 1, 0.5}, errors[] = {1e-3, 1e-2, 1e-2, NAN, 1e-6};
    struct bench_point points[5];
    make_points(times, errors, 5, points);
    points[4].family = FAMILY_SAMPLES;
    assert_ptr_equal(bench_fastest_within(points, 5, 1e-2), &points[1]);
    assert_ptr_equal(bench_fastest_within(points, 5, 5e-3), &points[0]);
    assert_null(bench_fastest_within(points, 5, 1e-4));
}

static void slope_of_a_power(void **state)
{
    (void)state;
    double x[] = {4, 8, 16, 32, 64, 128}, y[6];
    for (int i = 0; i < 6; ++i)
        y[i] = 3 * pow(x[i], -0.75);
    assert_near(log_log_slope(x, y, 6), -0.75, 1e-12);
    y[2] = 0; /* has no logarithm */
    y[3] = INFINITY;
    assert_near(log_log_slope(x, y, 6), -0.75, 1e-12);
    assert_true(isnan(log_log_slope(x, y, 4)));
    assert_true(isnan(log_log_slope((double[]){2, 2, 2}, y, 3)));
    /* least squares: by numpy.polyfit(log(x), log(y), 1) */
    assert_near(log_log_slope((double[]){1, 2, 4, 8}, (double[]){1, 0.6, 0.2, 0.15}, 4), -0.9795859, 1e-6);
}

static void quantiles(void **state)
{
    (void)state;
    const double sorted[] = {1, 2, 4, 8};
    assert_near(sorted_quantile(sorted, 4, 0), 1, 0);
    assert_near(sorted_quantile(sorted, 4, 1), 8, 0);
    assert_near(sorted_quantile(sorted, 4, 0.5), 3, 0);
    assert_near(sorted_quantile(sorted, 3, 0.5), 2, 0);
    assert_near(sorted_quantile(sorted, 1, 0.9), 1, 0);
    assert_near(sorted_quantile(sorted, 0, 0.5), 0, 0);
}

static void grid_covers_the_picture(void **state)
{
    (void)state;
    for (unsigned width = 1; width < 40; ++width)
        for (double most = 0.5; most < 2000; most *= 2) {
            struct pixel_grid grid = pixel_grid_fitting(width, 23, most);
            size_t last = pixel_grid_place(&grid, pixel_grid_count(&grid) - 1, width);
            assert_true(grid.columns >= 1 && grid.rows >= 1);
            assert_true(last < (size_t)width * 23);
            assert_true(width - last % width <= grid.step && 23 - last / width <= grid.step);
        }
    struct pixel_grid whole = pixel_grid_fitting(60, 40, 2400);
    assert_int_equal(whole.step, 1);
    assert_int_equal(pixel_grid_count(&whole), 2400);
}

/* Two by two pixels of 0.5; the truth differs by 0, 0.1 in green, NaN... */
static void errors_of_a_picture(void **state)
{
    (void)state;
    float rgb[12];
    double exact[12];
    for (int i = 0; i < 12; ++i)
        exact[i] = rgb[i] = 0.5F;
    const struct image image = {.width = 2, .height = 2, .rgb = rgb};
    const struct ground_truth truth = {.pixels = {.grid = pixel_grid_fitting(2, 2, 4), .rgb = exact}};
    struct bench_error error;
    assert_int_equal(bench_error_measure(&image, &truth, &error), STATUS_DONE);
    assert_true(error.max == 0 && error.rmse == 0 && error.rmse_uncertainty == 0 &&
                error.pixels_off_8bit == 0);
    exact[4] = 0.25;
    exact[9] = 0.501; /* less than a step of 8 bits */
    assert_int_equal(bench_error_measure(&image, &truth, &error), STATUS_DONE);
    assert_near(error.max, 0.25, 0);
    assert_near(error.rmse, sqrt((0.25 * 0.25 + 0.001 * 0.001) / 12), 1e-9);
    assert_near(error.relative_median, (0 + 0.001 / 0.501) / 2, 1e-9);
    assert_near(error.relative_999, 1 - 0.003 * (1 - 0.001 / 0.501), 1e-9);
    assert_near(error.absolute_999, 0.25 - 0.003 * 0.249, 1e-9);
    assert_int_equal(error.pixels_off_8bit, 1);
    rgb[0] = NAN;
    assert_int_equal(bench_error_measure(&image, &truth, &error), STATUS_DONE);
    assert_true(isinf(error.max) && isinf(error.rmse));
}

/* A bench of one scene with three settings; times in ms, their quartiles 10 % apart. */
static json_t *make_bench(const char *processor, double time_ms, double rmse, double max, int width)
{
    json_t *document =
        json_pack("{s:{s:s, s:i}, s:[]}", "machine", "processor", processor, "cores", 2, "scenes");
    json_t *points = json_array();
    for (int i = 0; i < 3; ++i) {
        double time = i == 1 ? time_ms : 10, error = i == 1 ? rmse : 1e-3;
        json_t *point = json_pack("{s:s, s:s, s:i, s:f, s:[f, f], s:i, s:{s:f, s:f, s:f}}", "options",
                                  i == 0   ? ""
                                  : i == 1 ? "--max-bounces 4"
                                           : "--fast",
                                  "family", i == 1 ? "bounces" : "mode", "samples", 1, "time_ms", time,
                                  "time_quartiles_ms", time * 0.95, time * 1.05, "runs", 21, "error", "rmse",
                                  error, "rmse_uncertainty", 1e-4, "max", max);
        json_array_append_new(points, point);
    }
    json_array_append_new(json_object_get(document, "scenes"),
                          json_pack("{s:s, s:i, s:i, s:s, s:s, s:o}", "scene", "a.yaml", "width", width,
                                    "height", 40, "truth", "quad", "truth_samples", "double", "points",
                                    points));
    return document;
}

/* Compares a bench with the plain one; the text in which that is said goes to text. */
static enum status compare_with_plain(json_t *new, char *text, size_t size)
{
    FILE *stream = fmemopen(text, size, "w");
    json_t *old = make_bench("one", 10, 1e-3, 0.5, 60);
    assert_non_null(stream);
    enum status status = bench_compare(old, new, stream);
    fclose(stream);
    json_decref(old);
    json_decref(new);
    return status;
}

static void compare_times(void **state)
{
    (void)state;
    char text[2000];
    assert_int_equal(compare_with_plain(make_bench("one", 10, 1e-3, 0.5, 60), text, sizeof text),
                     STATUS_DONE);
    assert_non_null(strstr(text, "compared 3 settings: 0 became worse, 0 better"));
    /* The standard error of the difference is sqrt(2) 1.2533 0.1 / 1.349 / sqrt(21) = 2.87 %: 11.5 % is four.
     */
    assert_int_equal(compare_with_plain(make_bench("one", 11.1, 1e-3, 0.5, 60), text, sizeof text),
                     STATUS_DONE);
    assert_int_equal(compare_with_plain(make_bench("one", 11.4, 1e-3, 0.5, 60), text, sizeof text),
                     STATUS_DIFFERS);
    assert_non_null(strstr(text, "a.yaml: --max-bounces 4: SLOWER: 11.4 ms, was 10 ms"));
    assert_int_equal(compare_with_plain(make_bench("one", 5, 1e-3, 0.5, 60), text, sizeof text), STATUS_DONE);
    assert_non_null(strstr(text, "a.yaml: --max-bounces 4: faster: 5 ms, was 10 ms"));
    assert_int_equal(compare_with_plain(make_bench("two", 50, 1e-3, 0.5, 60), text, sizeof text),
                     STATUS_DONE);
    assert_non_null(strstr(text, "another machine: processor two, was one"));
}

/* The same bench with two settings on the CPU, whose times and the others' are multiplied. */
static json_t *make_mixed_bench(double device_factor, double cpu_factor)
{
    json_t *document = make_bench("one", 10, 1e-3, 0.5, 60);
    json_t *scene = json_array_get(json_object_get(document, "scenes"), 0);
    json_t *points = json_object_get(scene, "points"), *point;
    size_t i;
    for (i = 0; i < 2; ++i) {
        point = json_deep_copy(json_array_get(points, i));
        json_object_set_new(point, "backend", json_string("cpu"));
        json_object_set_new(point, "options",
                            json_string(i == 0 ? "--backend cpu" : "--backend cpu --threads 1"));
        json_array_append_new(points, point);
    }
    json_array_foreach(points, i, point)
    {
        double time = 10 * (i < 3 ? device_factor : cpu_factor);
        json_object_set_new(point, "time_ms", json_real(time));
        json_object_set_new(point, "time_quartiles_ms", json_pack("[f, f]", 0.95 * time, 1.05 * time));
    }
    return document;
}

static void compare_with_control(void **state)
{
    (void)state;
    static const struct {
        double device, cpu;
        enum status expected;
        const char *says;
    } cases[] = {
        {2, 2, STATUS_DONE, "0 became worse, 0 better"}, /* the machine as a whole */
        {0.5, 0.5, STATUS_DONE, "0 became worse, 0 better"},
        {2, 1, STATUS_DIFFERS, "3 became worse, 0 better"},
        {1, 2, STATUS_DIFFERS, "2 became worse, 0 better"},
        {3, 2, STATUS_DIFFERS, "3 became worse, 0 better"}, /* slower than the machine */
        {1, 0.5, STATUS_DONE, "0 became worse, 2 better"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[2000];
        FILE *stream = fmemopen(text, sizeof text, "w");
        assert_non_null(stream);
        json_t *old = make_mixed_bench(1, 1), *new = make_mixed_bench(cases[i].device, cases[i].cpu);
        enum status status = bench_compare(old, new, stream);
        fclose(stream);
        json_decref(old);
        json_decref(new);
        if (status != cases[i].expected || !strstr(text, cases[i].says))
            fail_msg("case %zu: status %d: %s", i, status, text);
    }
}

static void compare_errors(void **state)
{
    (void)state;
    char text[2000];
    assert_int_equal(compare_with_plain(make_bench("two", 10, 1.001e-3, 0.5, 60), text, sizeof text),
                     STATUS_DIFFERS);
    assert_non_null(strstr(text, "--max-bounces 4: LESS ACCURATE, RMSE: 0.001, was 0.001"));
    assert_int_equal(compare_with_plain(make_bench("one", 10, 1e-3, 0.6, 60), text, sizeof text),
                     STATUS_DIFFERS);
    assert_non_null(strstr(text, "as the scene says: LESS ACCURATE, largest error: 0.6, was 0.5"));
    assert_int_equal(compare_with_plain(make_bench("one", 10, 1e-4, 0.5, 60), text, sizeof text),
                     STATUS_DONE);
    assert_non_null(strstr(text, "--max-bounces 4: more accurate, RMSE: 0.0001, was 0.001"));
    /* Sampled: four standard errors are 4 sqrt(2) 1e-4. */
    json_t *sampled = make_bench("one", 10, 1.5e-3, 0.6, 60);
    json_object_set_new(json_array_get(json_object_get(sampled, "scenes"), 0), "sampled", json_true());
    assert_int_equal(compare_with_plain(sampled, text, sizeof text), STATUS_DONE);
    sampled = make_bench("one", 10, 1.6e-3, 0.6, 60);
    json_object_set_new(json_array_get(json_object_get(sampled, "scenes"), 0), "sampled", json_true());
    assert_int_equal(compare_with_plain(sampled, text, sizeof text), STATUS_DIFFERS);
}

static void compare_nothing_in_common(void **state)
{
    (void)state;
    char text[2000];
    assert_int_equal(compare_with_plain(make_bench("one", 10, 1e-3, 0.5, 61), text, sizeof text),
                     STATUS_REFUSED);
    json_t *other_truth = make_bench("one", 10, 1, 0.5, 60);
    json_object_set_new(json_array_get(json_object_get(other_truth, "scenes"), 0), "truth",
                        json_string("other"));
    assert_int_equal(compare_with_plain(other_truth, text, sizeof text), STATUS_DONE);
    assert_non_null(strstr(text, "another truth"));
}

static void no_bench_document(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "[]", "{\"scenes\": []}", "{\"scenes\": [], \"machine\": {}"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        json_t *document;
        char message[256];
        FILE *file = fopen("old.json", "w");
        assert_non_null(file);
        fputs(texts[i], file);
        fclose(file);
        test_messages_begin();
        enum status status = bench_document_read("old.json", &document);
        assert_int_equal(test_messages_end(message), 1);
        assert_int_equal(status, STATUS_REFUSED);
        assert_null(document);
        assert_non_null(strstr(message, "old.json"));
    }
}

static struct scene glass;
static struct picture_settings glass_picture;
static bool deep_enough, truth_emptied = true;

static enum status deepest(void)
{
    struct packed_scene packed;
    unsigned most;
    enum status status = pack_scene(NULL, &glass, &glass_picture, &packed);
    if (status != STATUS_DONE)
        return status;
    status = ground_truth_bounces(&packed, &most);
    deep_enough = most == 64;
    pack_destroy(&packed);
    return status;
}

static enum status truth_and_error(void)
{
    struct ground_truth truth;
    struct progress progress;
    struct bench_error error;
    static float black[12 * 8 * 3];
    progress_start(&progress, "", 10, true);
    enum status status =
        ground_truth_create(&glass, NULL, glass_picture, TRUTH_EXACT, 1e4, &progress, 10, &truth);
    if (status != STATUS_DONE) {
        truth_emptied &= !truth.pixels.rgb;
        return status;
    }
    status = bench_error_measure(&(struct image){.width = 12, .height = 8, .rgb = black}, &truth, &error);
    grid_pixels_destroy(&truth.pixels);
    return status;
}

/* Each of the allocations fails once: that is reported once, and is no crash. */
static void no_memory(void **state)
{
    (void)state;
    enum status (*const tries[])(void) = {deepest, truth_and_error};
    glass = test_read("scenes/figure_3c.yaml");
    glass_picture = test_settings(&glass);
    glass_picture.width = 12;
    glass_picture.height = 8;
    for (size_t i = 0; i < sizeof tries / sizeof *tries; ++i) {
        int failures = 0;
        for (enum status status = STATUS_UNABLE; status != STATUS_DONE; ++failures) {
            char message[256];
            test_messages_begin();
            calls_to_failure = failures;
            status = tries[i]();
            bool failed = calls_to_failure < 0;
            calls_to_failure = -1;
            int messages = test_messages_end(message);
            if (status != (failed ? STATUS_UNABLE : STATUS_DONE) || messages != failed)
                fail_msg("try %zu, allocation %d: status %d, %d messages: %s", i, failures, (int)status,
                         messages, message);
        }
        assert_true(failures > 1);
    }
    assert_true(deep_enough && truth_emptied);
    scene_destroy(&glass);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_is_what_nothing_beats),
        cmocka_unit_test(fastest_within_an_error),
        cmocka_unit_test(slope_of_a_power),
        cmocka_unit_test(quantiles),
        cmocka_unit_test(grid_covers_the_picture),
        cmocka_unit_test(errors_of_a_picture),
        cmocka_unit_test(compare_times),
        cmocka_unit_test(compare_with_control),
        cmocka_unit_test(compare_errors),
        cmocka_unit_test(compare_nothing_in_common),
        cmocka_unit_test(no_memory),
        TEST_IN_FOLDER(no_bench_document),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
