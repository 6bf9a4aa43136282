/* 8-bit code values: the table gives what the formula gives, for every float. */
#include "cmocka_test.h"

#include <math.h>
#include <string.h>

#include "image/srgb.h"

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint8_t formula(float linear)
{
    double x = linear >= 0.0f ? (double)linear : 0.0; /* NaN: 0 */
    x = x > 1.0 ? 1.0 : x;
    double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (uint8_t)lround(255.0 * encoded);
}

static uint8_t encode(const struct srgb_encoder *encoder, float linear)
{
    uint8_t code;
    srgb_encode(encoder, &linear, 1, &code);
    return code;
}

static void check_range(const struct srgb_encoder *encoder, uint32_t first, uint32_t last, uint32_t step)
{
    for (uint64_t bits = first; bits <= last; bits += step) {
        float linear = float_of((uint32_t)bits);
        if (encode(encoder, linear) != formula(linear))
            fail_msg("%a (%.9g): code %d, the formula says %d", (double)linear, (double)linear,
                     encode(encoder, linear), formula(linear));
    }
}

/* Between two thresholds the formula is constant and the table's cell edges are multiples of 2^16 in the
 * bits: equal around all thresholds and at all cell edges is equal everywhere. */
static void test_thresholds(void **state)
{
    (void)state;
    struct srgb_encoder encoder;
    srgb_encoder_init(&encoder);
    uint32_t previous = 0;
    for (int code = 1; code <= 255; code++) {
        uint32_t below = previous, above = bits_of(1.0f);
        while (above - below > 1) {
            uint32_t middle = below + (above - below) / 2;
            if (formula(float_of(middle)) >= code)
                above = middle;
            else
                below = middle;
        }
        assert_int_equal(formula(float_of(above)), code);
        check_range(&encoder, above - 1000, above + 1000, 1);
        previous = above;
    }
    for (uint32_t edge = 0x10000; edge <= bits_of(4.0f); edge += 0x10000)
        check_range(&encoder, edge - 2, edge + 2, 1);
}

static void test_no_numbers(void **state)
{
    (void)state;
    struct srgb_encoder encoder;
    srgb_encoder_init(&encoder);
    const struct {
        float linear;
        uint8_t code;
    } cases[] = {
        {NAN, 0},
        {-NAN, 0},
        {-INFINITY, 0},
        {INFINITY, 255},
        {-1.0f, 0},
        {-0.0f, 0},
        {0.0f, 0},
        {0x1p-149f, 0},
        {1.0f, 255},
        {0x1.fffffep127f, 255},
        {float_of(0x7f800001), 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint8_t code = 77;
        assert_int_equal(encode(&encoder, cases[i].linear), cases[i].code);
        linear_encode(&cases[i].linear, 1, &code);
        assert_int_equal(code, cases[i].code);
    }
}

static void test_linear(void **state)
{
    (void)state;
    for (int code = 0; code <= 255; code++) {
        float middle = (float)((code - 0.5) / 255.0);
        for (int step = -4; step <= 4; step++) {
            float linear = code == 0 ? 0.0f : float_of(bits_of(middle) + (uint32_t)step);
            uint8_t encoded;
            linear_encode(&linear, 1, &encoded);
            assert_int_equal(encoded, lround(255.0 * (double)linear));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thresholds),
        cmocka_unit_test(test_no_numbers),
        cmocka_unit_test(test_linear),
    };
    return cmocka_run_group_tests_name("srgb", tests, NULL, NULL);
}
