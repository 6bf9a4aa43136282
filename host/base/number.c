#include "base/number.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t skip_digits(const char *text, size_t length, size_t at)
{
    while (at < length && text[at] >= '0' && text[at] <= '9')
        at++;
    return at;
}

static size_t skip_sign(const char *text, size_t length, size_t at)
{
    return at < length && (text[at] == '+' || text[at] == '-') ? at + 1 : at;
}

static bool is_decimal(const char *text, size_t length)
{
    size_t start = skip_sign(text, length, 0);
    size_t at = skip_digits(text, length, start);
    if (at == start)
        return false;
    if (at < length && text[at] == '.') {
        start = at + 1;
        at = skip_digits(text, length, start);
        if (at == start)
            return false;
    }
    if (at < length && (text[at] == 'e' || text[at] == 'E')) {
        start = skip_sign(text, length, at + 1);
        at = skip_digits(text, length, start);
        if (at == start)
            return false;
    }
    return at == length;
}

bool parse_double(const char *text, size_t length, double *value)
{
    char copy[NUMBER_MAX_LENGTH + 1];
    if (length > NUMBER_MAX_LENGTH || !is_decimal(text, length))
        return false;
    memcpy(copy, text, length);
    copy[length] = '\0';

    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!c_locale)
        return false;
    double parsed = strtod_l(copy, NULL, c_locale);
    freelocale(c_locale);
    if (!isfinite(parsed))
        return false;
    *value = parsed;
    return true;
}

/* The fewest digits that a double, or a float, is read from as this value. */
static const char *format(double value, bool as_float, char text[static NUMBER_TEXT])
{
    if (!isfinite(value)) {
        snprintf(text, NUMBER_TEXT, "%g", value);
        return text;
    }
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0), own_locale = (locale_t)0;
    if (c_locale)
        own_locale = uselocale(c_locale);
    int digits = 1;
    do
        snprintf(text, NUMBER_TEXT, "%.*e", digits - 1, value);
    while ((as_float ? (double)strtof(text, NULL) : strtod(text, NULL)) != value &&
           ++digits <= DBL_DECIMAL_DIG);
    long exponent = strtol(strchr(text, 'e') + 1, NULL, 10);
    if (exponent >= -5 && exponent < DBL_DIG)
        snprintf(text, NUMBER_TEXT, "%.*f", (int)fmax(0, (double)(digits - 1 - exponent)), value);
    if (c_locale) {
        uselocale(own_locale);
        freelocale(c_locale);
    }
    return text;
}

const char *format_double(double value, char text[static NUMBER_TEXT])
{
    return format(value, false, text);
}

const char *format_number(double value, char text[static NUMBER_TEXT])
{
    return format(value, (double)(float)value == value, text);
}

bool parse_unsigned(const char *text, size_t length, unsigned long max, unsigned long *value)
{
    if (length == 0 || length > NUMBER_MAX_LENGTH || skip_digits(text, length, 0) != length)
        return false;
    unsigned long parsed = 0;
    for (size_t i = 0; i < length; i++) {
        unsigned long digit = (unsigned long)(text[i] - '0');
        if (digit > max || parsed > (max - digit) / 10)
            return false;
        parsed = parsed * 10 + digit;
    }
    *value = parsed;
    return true;
}
