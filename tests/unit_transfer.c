/* 8-bit code values: the table gives what the formulas give, for every float. */
#include "cmocka_test.h"

#include <math.h>

#include "base/float_bits.h"
#include "image/transfer.h"

static uint8_t formula(enum transfer transfer, float linear)
{
    double x = linear >= 0.0f ? (double)linear : 0.0; /* NaN: 0 */
    x = x > 1.0 ? 1.0 : x;
    if (transfer == TRANSFER_SRGB)
        x = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (uint8_t)lround(255.0 * x);
}

static uint8_t encode(const struct transfer_encoder *encoder, float linear)
{
    uint8_t code;
    transfer_encode(encoder, &linear, 1, &code);
    return code;
}

static void check_range(enum transfer transfer, const struct transfer_encoder *encoder, uint32_t first,
                        uint32_t last)
{
    for (uint32_t bits = first; bits <= last; ++bits) {
        float linear = float_of_bits(bits);
        if (encode(encoder, linear) != formula(transfer, linear))
            fail_msg("%a (%.9g): code %d, the formula says %d", (double)linear, (double)linear,
                     encode(encoder, linear), formula(transfer, linear));
    }
}

/* Between two thresholds the formula is constant and the table's cell edges are multiples of 2^16 in the
 * bits: equal around all thresholds and at all cell edges is equal everywhere. */
static void check_thresholds(enum transfer transfer)
{
    struct transfer_encoder encoder;
    transfer_encoder_init(transfer, &encoder);
    uint32_t previous = 0;
    for (int code = 1; code <= 255; code++) {
        uint32_t below = previous, above = float_bits(1.0f);
        while (above - below > 1) {
            uint32_t middle = below + (above - below) / 2;
            if (formula(transfer, float_of_bits(middle)) >= code)
                above = middle;
            else
                below = middle;
        }
        assert_int_equal(formula(transfer, float_of_bits(above)), code);
        check_range(transfer, &encoder, above - 1000, above + 1000);
        previous = above;
    }
    for (uint32_t edge = 0x10000; edge <= float_bits(4.0f); edge += 0x10000)
        check_range(transfer, &encoder, edge - 2, edge + 2);
}

static void test_thresholds(void **state)
{
    (void)state;
    check_thresholds(TRANSFER_SRGB);
    check_thresholds(TRANSFER_LINEAR);
}

static void test_no_numbers(void **state)
{
    (void)state;
    static const struct {
        float linear;
        uint8_t code;
    } cases[] = {
        {NAN, 0},   {-NAN, 0}, {-INFINITY, 0}, {INFINITY, 255}, {-1.0f, 0},
        {-0.0f, 0}, {0.0f, 0}, {0x1p-149f, 0}, {1.0f, 255},     {0x1.fffffep127f, 255},
    };
    for (int transfer = TRANSFER_SRGB; transfer <= TRANSFER_LINEAR; ++transfer) {
        struct transfer_encoder encoder;
        transfer_encoder_init((enum transfer)transfer, &encoder);
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
            assert_int_equal(encode(&encoder, cases[i].linear), cases[i].code);
        assert_int_equal(encode(&encoder, float_of_bits(0x7f800001)), 0); /* a signalling NaN */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thresholds),
        cmocka_unit_test(test_no_numbers),
    };
    return cmocka_run_group_tests_name("transfer", tests, NULL, NULL);
}
