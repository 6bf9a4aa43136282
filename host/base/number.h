#ifndef VKWHITTED_BASE_NUMBER_H
#define VKWHITTED_BASE_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

/* Strict decimal numbers, in the C locale, which the program never leaves. The whole text must be the number:
 * no blanks, no hexadecimal, no "inf" or "nan". On failure these return false and leave *value alone. */

enum { NUMBER_MAX_LENGTH = 500 }; /* characters; longer texts are not numbers */

/* [+-]digits[.digits][e[+-]digits], also with E. False too where the number overflows; one too small for a
 * double becomes the nearest double, perhaps 0. */
bool parse_double(const char *text, size_t length, double *value);

/* Digits only, at most max. */
bool parse_unsigned(const char *text, size_t length, unsigned long max, unsigned long *value);

enum { NUMBER_TEXT = 32 }; /* room for a printed number */

/* The fewest digits that parse_double() reads as this value; return text. format_number() prints a value that
 * single precision has with the digits that it takes there. Not finite: inf or nan. */
const char *format_double(double value, char text[static NUMBER_TEXT]);
const char *format_number(double value, char text[static NUMBER_TEXT]);

#endif
