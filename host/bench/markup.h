#ifndef VKWHITTED_BENCH_MARKUP_H
#define VKWHITTED_BENCH_MARKUP_H

#include <stdio.h>

/* Text and numbers as they stand in HTML and SVG. Failed writes stay in the stream's error flag. */

/* UTF-8 text, as content or inside a quoted attribute. What XML cannot hold becomes U+FFFD. */
void markup_text(FILE *out, const char *text);

enum { MARKUP_NUMBER_SIZE = 48 };

/* An error to two digits, "1.2e-5"; "0" is exact, and one that is no number is infinite. Returns buffer. */
const char *markup_error(double error, char buffer[MARKUP_NUMBER_SIZE]);

/* Three digits or all that stand before the point, thousands set apart; below 0.001 as an error; a dash for
 * what is no number. Returns buffer. */
const char *markup_number(double number, char buffer[MARKUP_NUMBER_SIZE]);

/* A count, thousands set apart; a dash for what is no number. Returns buffer. */
const char *markup_count(double count, char buffer[MARKUP_NUMBER_SIZE]);

#endif
