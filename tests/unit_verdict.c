/* What a picture's pixel is by the exact one, and why. */
#include "cmocka_test.h"

#include <math.h>

#include "check/verdict.h"

/* Exactly half, with a bound that a close decision has widened where there is one. */
static struct reference_explanation half(double bound, double margin)
{
    return (struct reference_explanation){
        .rgb = {0.5, 0.5, 0.5}, .bound = {bound, bound, bound}, .margin = margin};
}

static void each_verdict(void **state)
{
    (void)state;
    const struct {
        struct value_range value;
        double bound, margin;
        struct tolerance tolerance;
        enum verdict verdict;
    } cases[] = {
        {{0.5f, 0.5f}, 1e-6, 1e9, {0, 0}, VERDICT_RIGHT},
        {{0.5000005f, 0.5000005f}, 1e-6, 1e9, {0, 0}, VERDICT_RIGHT},
        {{0.4999995f, 0.4999995f}, 1e-6, 1e9, {0, 0}, VERDICT_RIGHT},
        {{0.50001f, 0.50001f}, 1e-6, 1e9, {0, 0}, VERDICT_SLIGHTLY_OFF},
        {{0.4f, 0.4f}, 1e-6, 1e9, {0, 0}, VERDICT_WRONG},
        {{0.4f, 0.4f}, 1e-6, 999, {0, 0}, VERDICT_EDGE},
        {{0.4f, 0.4f}, 1e-6, 0.5, {0, 0}, VERDICT_EDGE}, /* the decision cannot change that much */
        {{0.4f, 0.4f}, 0.2, 0.5, {0, 0}, VERDICT_NEAR_DECISION},
        {{0.4999f, 0.4999f}, 0.2, 0.5, {0, 0}, VERDICT_RIGHT}, /* decided as exactly */
        {{0.4f, 0.4f}, 0.2, 1e9, {0, 0}, VERDICT_RIGHT},       /* a bound that is wide without a decision */
        /* what a format rounds */
        {{0.4f, 0.6f}, 0, 1e9, {0, 0}, VERDICT_RIGHT},
        {{0.4f, INFINITY}, 0, 1e9, {0, 0}, VERDICT_RIGHT},
        {{-INFINITY, 0.6f}, 0, 1e9, {0, 0}, VERDICT_RIGHT},
        {{0.6f, INFINITY}, 1e-6, 1e9, {0, 0}, VERDICT_WRONG},
        {{-INFINITY, 0.4f}, 1e-6, 1e9, {0, 0}, VERDICT_WRONG},
        {{0.6f, 0.7f}, 0.11, 1e9, {0, 0}, VERDICT_RIGHT}, /* and float, both */
        /* what is allowed */
        {{0.4f, 0.4f}, 1e-6, 1e9, {0.11, 0}, VERDICT_RIGHT},
        {{0.4f, 0.4f}, 1e-6, 1e9, {0, 0.21}, VERDICT_RIGHT},
        {{0.4f, 0.4f}, 1e-6, 1e9, {0.09, 0.01}, VERDICT_WRONG},
        /* what is no number */
        {{NAN, NAN}, 1, 0.5, {1, 1}, VERDICT_EDGE},
        {{NAN, NAN}, 1, 1e9, {1, 1}, VERDICT_WRONG},
        {{INFINITY, INFINITY}, 1, 1e9, {0, 0}, VERDICT_WRONG},
        {{-INFINITY, -INFINITY}, 1, 1e9, {0, 0}, VERDICT_WRONG},
        {{0.5f, 0.5f}, NAN, 1e9, {0, 0}, VERDICT_SLIGHTLY_OFF}, /* no bound is no excuse */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        for (int channel = 0; channel < 3; ++channel) {
            struct value_range rgb[3] = {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}};
            const struct read_image picture = {1, 1, rgb};
            const struct reference_explanation exact = half(cases[i].bound, cases[i].margin);
            struct verdicts verdicts;
            rgb[channel] = cases[i].value;
            const enum status status = verdicts_find(&picture, &exact, &cases[i].tolerance, &verdicts);
            if (verdicts.pixels[cases[i].verdict] != 1)
                fail_msg("case %zu is no %d", i, cases[i].verdict);
            assert_int_equal(status, cases[i].verdict > VERDICT_NEAR_DECISION ? STATUS_DIFFERS : STATUS_DONE);
            assert_int_equal(verdicts_wrong(&verdicts), status == STATUS_DIFFERS);
        }
}

/* The largest error is the wrong pixels', where there are some, and otherwise that of all. */
static void largest_error(void **state)
{
    (void)state;
    struct value_range rgb[12];
    struct reference_explanation exact[4] = {half(1e-6, 1e9), half(0.5, 0.5), half(1e-6, 1e9),
                                             half(1e-6, 20)};
    for (int i = 0; i < 12; ++i)
        rgb[i] = (struct value_range){0.5f, 0.5f};
    const struct read_image picture = {2, 2, rgb};
    struct verdicts verdicts;
    rgb[3].low = rgb[3].high = 0.125f; /* (1, 0), near a decision */
    assert_int_equal(verdicts_find(&picture, exact, &(struct tolerance){0, 0}, &verdicts), STATUS_DONE);
    assert_true(verdicts.x == 1 && verdicts.y == 0 && verdicts.channel == 0 && verdicts.error == 0.375);
    rgb[7].low = 0.5625f;
    rgb[7].high = 0.625f; /* (0, 1) */
    rgb[11].low = rgb[11].high = 0.53125f;
    assert_int_equal(verdicts_find(&picture, exact, &(struct tolerance){0, 0}, &verdicts), STATUS_DIFFERS);
    assert_true(verdicts.x == 0 && verdicts.y == 1 && verdicts.channel == 1 && verdicts.error == 0.0625);
    assert_true(verdicts.value.low == 0.5625f && verdicts.exact == 0.5 && verdicts.margin == 1e9);
    assert_int_equal(verdicts.pixels[VERDICT_RIGHT], 1);
    assert_int_equal(verdicts.pixels[VERDICT_NEAR_DECISION], 1);
    assert_int_equal(verdicts.pixels[VERDICT_EDGE], 1);
    assert_int_equal(verdicts.pixels[VERDICT_WRONG], 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_verdict), cmocka_unit_test(largest_error)};
    return cmocka_run_group_tests_name("verdict", tests, NULL, NULL);
}
