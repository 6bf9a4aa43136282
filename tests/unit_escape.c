/* What a terminal would obey is shown instead; all other text stays as it is. */
#include "cmocka_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/escape.h"

static void assert_shown(const char *text, const char *expected)
{
    char *shown = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&shown, &size);
    assert_non_null(stream);
    escape_line(stream, text);
    assert_int_equal(fclose(stream), 0);
    assert_true(size > 0 && shown[size - 1] == '\n');
    shown[size - 1] = '\0';
    assert_string_equal(shown, expected);
    free(shown);
}

static void test_lines(void **state)
{
    (void)state;
    assert_shown("", "");
    assert_shown("a b \\ ~ ÷ √ Œ 日本 \xF0\x9F\x99\x82", "a b \\ ~ ÷ √ Œ 日本 \xF0\x9F\x99\x82");
    assert_shown("\x1B[31m\a\b\t\n\r\x7F", "\\x1b[31m\\x07\\x08\\x09\\x0a\\x0d\\x7f");
    assert_shown("\xC2\x80\xC2\x9B\xC2\x9F\xC2\xA0", "\\u0080\\u009b\\u009f\xC2\xA0");
    assert_shown("\xE2\x80\xAA\xE2\x80\xAE\xE2\x81\xA6\xE2\x81\xA9\xE2\x80\x8F\xD8\x9C\xE2\x80\xA8",
                 "\\u202a\\u202e\\u2066\\u2069\\u200f\\u061c\\u2028");
    /* Latin-1, overlong, a surrogate, beyond Unicode, cut off */
    assert_shown("\x9B\xE4\xFF", "\\x9b\\xe4\\xff");
    assert_shown("\xC0\x9B\xE0\x80\x9B", "\\xc0\\x9b\\xe0\\x80\\x9b");
    assert_shown("\xED\xA0\x80", "\\xed\\xa0\\x80");
    assert_shown("\xF4\x90\x80\x80", "\\xf4\\x90\\x80\\x80");
    assert_shown("a\xE2\x80", "a\\xe2\\x80");
}

/* Each code point: one of the two, and a control character if it is one in Unicode's lists. */
static void test_every_character(void **state)
{
    (void)state;
    size_t escaped = 0;
    for (uint32_t code = 1; code < 0x110000; ++code) {
        char text[5] = {(char)code}, shown[ESCAPED_SIZE];
        size_t size = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
        for (size_t i = size; size > 1 && i-- > 0;)
            text[i] = (char)(i > 0 ? 0x80 | (code >> (6 * (size - 1 - i)) & 0x3F)
                                   : (0xF00U >> size & 0xFF) | code >> (6 * (size - 1)));
        if (code >= 0xD800 && code < 0xE000)
            continue;
        assert_int_equal(escape_character(text, size, shown), size);
        escaped += strcmp(shown, text) != 0;
    }
    assert_int_equal(escaped, 31 + 33 + 1 + 2 + 7 + 4 + 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lines),
        cmocka_unit_test(test_every_character),
    };
    return cmocka_run_group_tests_name("escape", tests, NULL, NULL);
}
