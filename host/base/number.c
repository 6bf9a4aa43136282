#include "base/number.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether there are digits at *at, which then moves behind them. */
static bool skip_digits(const char **at)
{
    const size_t count = strspn(*at, "0123456789");
    *at += count;
    return count > 0;
}

static bool skip_sign_and_digits(const char **at)
{
    *at += **at == '+' || **at == '-';
    return skip_digits(at);
}

static bool is_decimal(const char *at)
{
    if (!skip_sign_and_digits(&at))
        return false;
    if (*at == '.' && (++at, !skip_digits(&at)))
        return false;
    if ((*at == 'e' || *at == 'E') && (++at, !skip_sign_and_digits(&at)))
        return false;
    return *at == '\0';
}

/* Copies the text with a 0 at its end; false where it is too long or has one inside. */
static bool copy_text(const char *text, size_t length, char copy[static NUMBER_MAX_LENGTH + 1])
{
    if (length > NUMBER_MAX_LENGTH)
        return false;
    memcpy(copy, text, length);
    copy[length] = '\0';
    return strlen(copy) == length;
}

bool parse_double(const char *text, size_t length, double *value)
{
    char copy[NUMBER_MAX_LENGTH + 1];
    if (!copy_text(text, length, copy) || !is_decimal(copy))
        return false;
    const double parsed = strtod(copy, NULL);
    if (!isfinite(parsed))
        return false;
    *value = parsed;
    return true;
}

bool parse_unsigned(const char *text, size_t length, unsigned long max, unsigned long *value)
{
    char copy[NUMBER_MAX_LENGTH + 1];
    const char *end = copy;
    if (!copy_text(text, length, copy) || !skip_digits(&end) || *end)
        return false;
    errno = 0;
    const unsigned long parsed = strtoul(copy, NULL, 10);
    if (errno != 0 || parsed > max)
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
    int digits = 1;
    do
        snprintf(text, NUMBER_TEXT, "%.*e", digits - 1, value);
    while ((as_float ? (double)strtof(text, NULL) : strtod(text, NULL)) != value &&
           ++digits <= DBL_DECIMAL_DIG);
    const long exponent = strtol(strchr(text, 'e') + 1, NULL, 10);
    if (exponent >= -5 && exponent < DBL_DIG)
        snprintf(text, NUMBER_TEXT, "%.*f", (int)fmax(0, (double)(digits - 1 - exponent)), value);
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
