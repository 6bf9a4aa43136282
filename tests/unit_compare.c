/* Comparison of pictures, and the picture of their differences. */
#include "cmocka_test.h"

#include <math.h>
#include <png.h>
#include <string.h>

#include "base/float_bits.h"
#include "check/compare.h"
#include "check/heatmap.h"
#include "test_folder.h"

static struct image picture(unsigned width, unsigned height)
{
    struct image image;
    assert_int_equal(image_create(width, height, &image), STATUS_DONE);
    return image;
}

/* Compares two pictures of one pixel whose green values are a and b. */
static struct comparison compare_values(float a, float b, const struct tolerance *tolerance)
{
    struct image image_a = {.width = 1, .height = 1, .rgb = (float[]){1.0f, a, 1.0f}};
    struct image image_b = {.width = 1, .height = 1, .rgb = (float[]){1.0f, b, 1.0f}};
    struct comparison comparison = image_compare(&image_a, &image_b, tolerance);
    if (comparison.bit_differing)
        assert_int_equal(comparison.channel, 1);
    return comparison;
}

static void test_values(void **state)
{
    (void)state;
    const float nan = float_of_bits(0x7fc00000), other_nan = float_of_bits(0xffc00001);
    const struct tolerance none = {0.0, 0.0}, wide = {1e30, 1e30}, absolute = {0.25, 0.0},
                           relative = {0.0, 0.25};
    const struct {
        float a, b;
        const struct tolerance *tolerance;
        size_t bit_differing, differing;
        double max_error;
    } cases[] = {
        {0.5f, 0.5f, NULL, 0, 0, 0.0},
        {0.5f, float_of_bits(0x3f000001), NULL, 1, 1, 0x1p-24},
        {-0.0f, 0.0f, NULL, 1, 1, 0.0},
        {-0.0f, 0.0f, &none, 1, 0, 0.0},
        {nan, nan, NULL, 0, 0, 0.0},
        {nan, other_nan, NULL, 1, 1, 0.0},
        {nan, other_nan, &none, 1, 0, 0.0},
        {nan, 1.0f, NULL, 1, 1, INFINITY},
        {1.0f, nan, &wide, 1, 1, INFINITY},
        {INFINITY, INFINITY, NULL, 0, 0, 0.0},
        {INFINITY, INFINITY, &none, 0, 0, 0.0},
        {INFINITY, -INFINITY, &wide, 1, 1, INFINITY},
        {INFINITY, 3e38f, &wide, 1, 1, INFINITY},
        {3e38f, INFINITY, &wide, 1, 1, INFINITY},
        {INFINITY, nan, &wide, 1, 1, INFINITY},
        {3e38f, -3e38f, NULL, 1, 1, 2.0 * (double)3e38f},
        {1.0f, 1.25f, &absolute, 1, 0, 0.25},
        {1.0f, 1.2500001f, &absolute, 1, 1, (double)1.2500001f - 1.0},
        {-1.0f, -1.25f, &absolute, 1, 0, 0.25},
        {3.0f, 4.0f, &relative, 1, 0, 1.0},
        {4.0f, 3.0f, &relative, 1, 0, 1.0},
        {2.9999998f, 4.0f, &relative, 1, 1, 4.0 - (double)2.9999998f},
        {-3.0f, -4.0f, &relative, 1, 0, 1.0},
        {0x1p-149f, 0.0f, &relative, 1, 1, 0x1p-149},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct comparison found = compare_values(cases[i].a, cases[i].b, cases[i].tolerance);
        if (found.bit_differing != cases[i].bit_differing || found.differing != cases[i].differing ||
            found.max_error != cases[i].max_error)
            fail_msg("case %zu (%a, %a): %zu bits, %zu differing, error %g", i, (double)cases[i].a,
                     (double)cases[i].b, found.bit_differing, found.differing, found.max_error);
    }
}

static void test_pixels_are_counted_and_the_worst_is_found(void **state)
{
    (void)state;
    struct image a = picture(7, 5), b = picture(7, 5);
    float *at_2_1 = b.rgb + (1 * 7 + 2) * 3, *at_6_4 = b.rgb + (4 * 7 + 6) * 3;
    at_2_1[0] = 0.5f;
    at_2_1[1] = 1.0f;
    at_2_1[2] = 1.0f;
    at_6_4[2] = 0.75f;

    struct comparison comparison = image_compare(&a, &b, NULL);
    assert_int_equal(comparison.differing, 2);
    assert_int_equal(comparison.bit_differing, 2);
    assert_true(comparison.max_error == 1.0);
    assert_int_equal(comparison.x, 2);
    assert_int_equal(comparison.y, 1);
    assert_int_equal(comparison.channel, 1);

    /* The larger error agrees (1000 against 1000.5), the smaller one does not. */
    memcpy(a.rgb, b.rgb, 7 * 5 * 3 * sizeof(float));
    a.rgb[0] = 1000.0f;
    b.rgb[0] = 1000.5f;
    at_6_4[2] = 0.5f;
    const struct tolerance relative = {0.0, 1e-3};
    comparison = image_compare(&a, &b, &relative);
    assert_int_equal(comparison.differing, 1);
    assert_int_equal(comparison.bit_differing, 2);
    assert_true(comparison.max_error == 0.25);
    assert_int_equal(comparison.x, 6);
    assert_int_equal(comparison.y, 4);
    assert_int_equal(comparison.channel, 2);

    const struct tolerance wide = {0.3, 1e-3};
    comparison = image_compare(&a, &b, &wide);
    assert_int_equal(comparison.differing, 0);
    assert_true(comparison.max_error == 0.5);
    assert_int_equal(comparison.x + comparison.y + comparison.channel, 0);
    image_destroy(&a);
    image_destroy(&b);
}

/* A difference that float does not show. */
static void test_double_precision(void **state)
{
    (void)state;
    struct image a = picture(2, 2), b = picture(2, 2);
    assert_int_equal(image_widen(&a) | image_widen(&b), STATUS_DONE);
    assert_int_equal(image_compare(&a, &b, NULL).differing, 0);
    b.rgb64[5] = 0x1p-60;
    const struct comparison comparison = image_compare(&a, &b, NULL);
    assert_int_equal(comparison.differing, 1);
    assert_true(comparison.max_error == 0x1p-60);
    image_destroy(&a);
    image_destroy(&b);
}

static void test_heatmap(void **state)
{
    (void)state;
    const struct {
        float a[3], b[3];
        uint8_t rgb[3];
    } pixels[] = {
        {{1, 2, 3}, {1, 2, 3}, {0, 0, 0}},
        {{1, NAN, 3}, {1, NAN, 3}, {0, 0, 0}},
        {{1, NAN, 3}, {1, 2, 3}, {255, 255, 255}},
        {{1, 2, 3}, {INFINITY, 2, 3}, {255, 255, 255}},
        {{0, 0, 0}, {0, -0.0f, 0}, {68, 1, 84}},
        {{1, 1, 1}, {1 - 0x1p-24f, 1, 1}, {68, 1, 84}},
        {{1, 1, 1}, {1 - 0x1p-18f, 1, 1}, {59, 82, 139}},
        {{8, 1, 1}, {8, 1 - 0x1p-12f, 1 - 0x1p-20f}, {33, 145, 140}},
        {{1, 1, 64}, {1, 1, 63}, {94, 201, 98}},
        {{1, 1, 1}, {0, 1, 1}, {253, 231, 37}},
        {{1, 1, 1}, {-1, 1, 1}, {253, 231, 37}},
    };
    enum { COUNT = sizeof pixels / sizeof pixels[0] };
    struct image a = picture(COUNT, 2), b = picture(COUNT, 2);
    for (size_t i = 0; i < COUNT; i++) {
        memcpy(a.rgb + (COUNT + i) * 3, pixels[i].a, sizeof pixels[i].a);
        memcpy(b.rgb + (COUNT + i) * 3, pixels[i].b, sizeof pixels[i].b);
    }
    const struct heatmap heatmap = difference_heatmap(&(struct image_pair){&a, &b});
    assert_int_equal(heatmap_write(&heatmap, "heat.png"), STATUS_DONE);

    uint8_t found[2][COUNT][3];
    png_image png = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&png, "heat.png"));
    assert_int_equal(png.width, COUNT);
    assert_int_equal(png.height, 2);
    png.format = PNG_FORMAT_RGB;
    assert_true(png_image_finish_read(&png, NULL, found, 0, NULL));
    for (size_t i = 0; i < COUNT; i++) {
        assert_memory_equal(found[0][i], pixels[0].rgb, 3);
        assert_memory_equal(found[1][i], pixels[i].rgb, 3);
    }
    image_destroy(&a);
    image_destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_pixels_are_counted_and_the_worst_is_found),
        cmocka_unit_test(test_double_precision),
        TEST_IN_FOLDER(test_heatmap),
    };
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
