#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "watch/fit.h"

static void test_places(void **state)
{
    (void)state;
    static const struct {
        unsigned picture[2], window[2];
        struct fit fit;
    } cases[] = {
        {{320, 200}, {320, 200}, {0, 0, 320, 200}},
        {{320, 200}, {500, 200}, {90, 0, 320, 200}},
        {{320, 200}, {320, 301}, {0, 50, 320, 200}},
        {{320, 200}, {3000, 2000}, {0, 62, 3000, 1875}},
        {{320, 200}, {160, 1000}, {0, 450, 160, 100}},
        {{320, 200}, {1, 1}, {0, 0, 1, 1}},
        {{320, 200}, {1, 1000}, {0, 499, 1, 1}},
        {{320, 200}, {1000, 1}, {499, 0, 2, 1}},
        {{65536, 1}, {100, 100}, {0, 49, 100, 1}},
        {{1, 65536}, {65536, 65536}, {32767, 0, 1, 65536}},
        {{65536, 65536}, {65535, 65536}, {0, 0, 65535, 65535}},
        {{320, 200}, {0, 100}, {0, 0, 0, 0}},
        {{320, 200}, {100, 0}, {0, 0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const struct rgba_picture picture = {cases[i].picture[0], cases[i].picture[1], NULL};
        struct fit fit = fit_picture(&picture, cases[i].window[0], cases[i].window[1]);
        if (memcmp(&fit, &cases[i].fit, sizeof fit) != 0)
            fail_msg("case %zu: at %u, %u, %u x %u", i, fit.x, fit.y, fit.width, fit.height);
    }
}

/* Draws a picture of 2 x 2 and compares red: the other channels and alpha follow from it. */
static void assert_draws(unsigned width, unsigned height, const unsigned char *expected_red)
{
    unsigned char rgba[2 * 2 * 4], pixels[8 * 8 * 4 + 1];
    static const unsigned char red[] = {10, 21, 31, 40};
    for (int i = 0; i < 4; ++i)
        memcpy(
            rgba + 4 * i,
            (const unsigned char[]){red[i], (unsigned char)(red[i] + 100), (unsigned char)(red[i] + 200), 7},
            4);
    for (int blue_first = 0; blue_first <= 1; ++blue_first) {
        pixels[4 * width * height] = 99;
        fit_draw(&(struct rgba_picture){2, 2, rgba}, width, height, blue_first, pixels);
        assert_int_equal(pixels[4 * width * height], 99);
        for (unsigned i = 0; i < width * height; ++i) {
            const unsigned char *pixel = pixels + (size_t)4 * i;
            unsigned char black = expected_red[i] == 0;
            assert_int_equal(pixel[blue_first ? 2 : 0], expected_red[i]);
            assert_int_equal(pixel[1], black ? 0 : expected_red[i] + 100);
            assert_int_equal(pixel[blue_first ? 0 : 2], black ? 0 : expected_red[i] + 200);
            assert_int_equal(pixel[3], 255);
        }
    }
}

static void test_same_size(void **state)
{
    (void)state;
    assert_draws(2, 2, (const unsigned char[]){10, 21, 31, 40});
    assert_draws(5, 2, (const unsigned char[]){0, 10, 21, 0, 0, 0, 31, 40, 0, 0});
    assert_draws(2, 3, (const unsigned char[]){10, 21, 31, 40, 0, 0});
}

static void test_enlarged(void **state)
{
    (void)state;
    assert_draws(4, 4,
                 (const unsigned char[]){10, 10, 21, 21, 10, 10, 21, 21, 31, 31, 40, 40, 31, 31, 40, 40});
    assert_draws(3, 3, (const unsigned char[]){10, 10, 21, 10, 10, 21, 31, 31, 40});
}

static void test_reduced(void **state)
{
    (void)state;
    assert_draws(1, 1, (const unsigned char[]){26}); /* 25.5 */
    assert_draws(1, 3, (const unsigned char[]){0, 26, 0});

    enum { LARGE = 1000 };
    struct rgba_picture picture = {LARGE, LARGE, calloc(LARGE * LARGE, 4)};
    assert_non_null(picture.rgba);
    memset(picture.rgba, 255, (size_t)LARGE * LARGE * 4);
    unsigned char pixels[7 * 9 * 4];
    fit_draw(&picture, 7, 9, false, pixels);
    for (size_t i = 0; i < sizeof pixels; ++i)
        assert_int_equal(pixels[i], i % 4 == 3 || (i >= 7 * 4 && i < 8 * 7 * 4) ? 255 : 0);
    free(picture.rgba);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_same_size),
        cmocka_unit_test(test_enlarged),
        cmocka_unit_test(test_reduced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
