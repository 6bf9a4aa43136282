/* Numbers and text as they stand in the report. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>

#include "bench/log_axis.h"
#include "bench/markup.h"

#define SPACE "\xE2\x80\xAF" /* narrow, no-break */

static void test_errors(void **state)
{
    (void)state;
    static const struct {
        double error;
        const char *text;
    } cases[] = {
        {0.0, "0"},           {-0.0, "0"},        {NAN, "∞"},           {INFINITY, "∞"},
        {1.1e-7, "1.1e-7"},   {1e-10, "1.0e-10"}, {3e-300, "3.0e-300"}, {0.00999, "1.0e-2"},
        {0.09949, "9.9e-2"},  {0.0996, "0.10"},   {0.123, "0.12"},      {0.9951, "1.0"},
        {9.94, "9.9"},        {9.96, "10"},       {999.4, "999"},       {1000.0, "1.0e3"},
        {DBL_MAX, "1.8e308"},
    };
    char buffer[MARKUP_NUMBER_SIZE];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_string_equal(markup_error(cases[i].error, buffer), cases[i].text);
}

static void test_numbers(void **state)
{
    (void)state;
    static const struct {
        double number;
        const char *text;
    } cases[] = {
        {0.0, "0"},
        {NAN, "–"},
        {INFINITY, "–"},
        {1e15, "–"},
        {0.0012345, "0.00123"},
        {1.06e-20, "1.1e-20"},
        {1.0, "1.00"},
        {12.34, "12.3"},
        {123.4, "123"},
        {1234.0, "1" SPACE "234"},
        {123456.0, "123" SPACE "456"},
        {-1234567.0, "-1" SPACE "234" SPACE "567"},
        {999999999999999.0, "999" SPACE "999" SPACE "999" SPACE "999" SPACE "999"},
    };
    char buffer[MARKUP_NUMBER_SIZE];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_string_equal(markup_number(cases[i].number, buffer), cases[i].text);
    assert_string_equal(markup_count(240000.0, buffer), "240" SPACE "000");
    assert_string_equal(markup_count(7.0, buffer), "7");
    assert_string_equal(markup_count(NAN, buffer), "–");
}

static void test_text(void **state)
{
    (void)state;
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    markup_text(out, "a<b>&\"c' \x01\x1b\r\n\tŒ");
    assert_int_equal(fclose(out), 0);
    assert_string_equal(text, "a&lt;b&gt;&amp;&quot;c' \xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\n\tŒ");
    free(text);
}

/* 0 and infinity stand beside all others, also beside those that lie close together. */
static void test_axis(void **state)
{
    (void)state;
    static const double values[][2] = {{1e-16, 1.0}, {1e-7, 1.0000001e-7}, {1e-38, 1e38}, {5.0, 5.0}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        struct log_axis axis = {.name = 'x', .start = 50.0, .end = 350.0};
        log_axis_include(&axis, values[i][1]);
        log_axis_include(&axis, NAN);
        log_axis_include(&axis, values[i][0]);
        log_axis_include(&axis, 0.0);
        log_axis_finish(&axis);
        double zero = log_axis_pixel(&axis, 0.0), low = log_axis_pixel(&axis, values[i][0]);
        double high = log_axis_pixel(&axis, values[i][1]), infinity = log_axis_pixel(&axis, INFINITY);
        assert_true(50.0 < zero && zero + 15.0 < low && low <= high && high + 15.0 < infinity &&
                    infinity < 350.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_text),
        cmocka_unit_test(test_axis),
    };
    return cmocka_run_group_tests_name("markup", tests, NULL, NULL);
}
