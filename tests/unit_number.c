#include "cmocka_test.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

static const struct {
    const char *text;
    double value;
} doubles[] = {
    {"0", 0},
    {"007", 7},
    {"+5", 5},
    {"-1.5", -1.5},
    {"0.1", 0.1},
    {"1e3", 1000},
    {"1E-3", 0.001},
    {"2.5e+2", 250},
    {"1e-400", 0},
    {"4.9e-324", 0x1p-1074},
    {"1.7976931348623157e308", 0x1.fffffffffffffp+1023},
    {"0.30000000000000004", 0.1 + 0.2},
    {"9007199254740993", 0x1p53},
};

static const char *const not_doubles[] = {
    "",      " ",
    "+",     "-",
    ".",     "1x",
    "x1",    "1 ",
    " 1",    "1.",
    ".5",    "1.e3",
    "1e",    "1e+",
    "e5",    "--1",
    "+-1",   "1.2.3",
    "1e5.0", "0x10",
    "0x1p3", "1f",
    "nan",   "inf",
    "-inf",  "infinity",
    "1e999", "-1e999",
    "1,5",   "1_000",
    "1e5e5", "\t1",
    "1\n",   "1.7976931348623159e308",
};

static void test_doubles(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof(doubles) / sizeof(doubles[0]); i++) {
        double value = NAN;
        if (!parse_double(doubles[i].text, strlen(doubles[i].text), &value) || value != doubles[i].value)
            fail_msg("\"%s\" became %.17g instead of %.17g", doubles[i].text, value, doubles[i].value);
    }
    double zero = 1;
    assert_true(parse_double("-0", 2, &zero));
    assert_true(zero == 0 && signbit(zero));
}

static void test_not_doubles(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof(not_doubles) / sizeof(not_doubles[0]); i++) {
        double value = 42;
        if (parse_double(not_doubles[i], strlen(not_doubles[i]), &value) || value != 42)
            fail_msg("\"%s\" was taken for the number %g", not_doubles[i], value);
    }
}

static void test_length_counts(void **state)
{
    (void)state;
    double value = 0;
    assert_true(parse_double("1234", 2, &value));
    assert_true(value == 12);
    assert_false(parse_double("1\0002", 3, &value));

    char digits[NUMBER_MAX_LENGTH + 1];
    memset(digits, '0', sizeof(digits));
    assert_true(parse_double(digits, NUMBER_MAX_LENGTH, &value));
    assert_false(parse_double(digits, NUMBER_MAX_LENGTH + 1, &value));
}

static void test_unsigned(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        unsigned long max;
        bool good;
        unsigned long value;
    } cases[] = {
        {"0", 0, true, 0},
        {"1", 0, false, 0},
        {"10", 9, false, 0},
        {"9", 9, true, 9},
        {"65536", 65536, true, 65536},
        {"65537", 65536, false, 0},
        {"00012", 20, true, 12},
        {"18446744073709551615", ULONG_MAX, ULONG_MAX == 18446744073709551615U, ULONG_MAX},
        {"18446744073709551616", ULONG_MAX, false, 0},
        {"99999999999999999999999", ULONG_MAX, false, 0},
        {"", 9, false, 0},
        {"-1", 9, false, 0},
        {"+1", 9, false, 0},
        {"1.0", 9, false, 0},
        {"1e0", 9, false, 0},
        {"1x", 9, false, 0},
        {" 1", 9, false, 0},
        {"0x1", 9, false, 0},
    };
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        unsigned long value = 42;
        bool good = parse_unsigned(cases[i].text, strlen(cases[i].text), cases[i].max, &value);
        if (good != cases[i].good || value != (good ? cases[i].value : 42))
            fail_msg("\"%s\" up to %lu: %s, %lu", cases[i].text, cases[i].max, good ? "taken" : "refused",
                     value);
    }
}

/* format_number() is the same but for what single precision has. */
static void shortest(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *as_double, *as_number;
    } cases[] = {
        {0, "0", "0"},
        {-0.0, "-0", "-0"},
        {60, "60", "60"},
        {-1.5, "-1.5", "-1.5"},
        {0.1, "0.1", "0.1"},
        {(double)0.1f, "0.10000000149011612", "0.1"},
        {0.1 + 0.2, "0.30000000000000004", "0.30000000000000004"},
        {123456, "123456", "123456"},
        {16777216, "16777216", "16777216"},
        {1.0 / 3, "0.3333333333333333", "0.3333333333333333"},
        {(double)(1.0f / 3), "0.3333333432674408", "0.33333334"},
        {1e-5, "0.00001", "0.00001"},
        {1e-6, "1e-06", "1e-06"},
        {1e14, "100000000000000", "100000000000000"},
        {1e15, "1e+15", "1e+15"},
        {0x1p-149, "1.401298464324817e-45", "1e-45"},
        {0x1p-1074, "5e-324", "5e-324"},
        {-0x1.fffffffffffffp+1023, "-1.7976931348623157e+308", "-1.7976931348623157e+308"},
        {INFINITY, "inf", "inf"},
        {(double)NAN, "nan", "nan"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[NUMBER_TEXT];
        assert_string_equal(format_double(cases[i].value, text), cases[i].as_double);
        assert_string_equal(format_number(cases[i].value, text), cases[i].as_number);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_doubles),       cmocka_unit_test(test_not_doubles),
        cmocka_unit_test(test_length_counts), cmocka_unit_test(test_unsigned),
        cmocka_unit_test(shortest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
