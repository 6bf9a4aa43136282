#include "base/number.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Copies the text with a 0 at its end; false where it is empty or too long or has other characters. */
static bool copy_text(const char *text, size_t length, const char *characters,
                      char copy[static NUMBER_MAX_LENGTH + 1])
{
    if (length == 0 || length > NUMBER_MAX_LENGTH)
        return false;
    memcpy(copy, text, length);
    copy[length] = '\0';
    return strspn(copy, characters) == length;
}

bool parse_double(const char *text, size_t length, double *value)
{
    char copy[NUMBER_MAX_LENGTH + 1], *end;
    if (!copy_text(text, length, "+-.0123456789eE", copy))
        return false;
    const double parsed = strtod(copy, &end);
    const char *point = strchr(copy, '.'); /* strtod() wants digits on one side of it only */
    if (*end || !isfinite(parsed) ||
        (point && (point == copy || !isdigit((unsigned char)point[-1]) || !isdigit((unsigned char)point[1]))))
        return false;
    *value = parsed;
    return true;
}

bool parse_unsigned(const char *text, size_t length, unsigned long max, unsigned long *value)
{
    char copy[NUMBER_MAX_LENGTH + 1];
    if (!copy_text(text, length, "0123456789", copy))
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
    int digits = 1;
    do
        snprintf(text, NUMBER_TEXT, "%.*e", digits - 1, value);
    while ((as_float ? (double)strtof(text, NULL) : strtod(text, NULL)) != value &&
           ++digits <= DBL_DECIMAL_DIG);
    const char *letter = strchr(text, 'e'); /* in "inf" and "nan" there is none */
    const long exponent = letter ? strtol(letter + 1, NULL, 10) : LONG_MAX;
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
