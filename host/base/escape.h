#ifndef VKWHITTED_BASE_ESCAPE_H
#define VKWHITTED_BASE_ESCAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Text from elsewhere (names of files and objects, lines of a scene file, what a driver or compiler says) may
 * hold control characters, by which a terminal does things, and marks that change the direction of what
 * follows. They are shown as \x1b or \u202e, and so is every byte that is not UTF-8. */

/* How many of the `length` > 0 bytes at text the character there has, and its code point; 0: it is not UTF-8.
 */
size_t utf8_decode(const char *text, size_t length, uint32_t *code);

enum { ESCAPED_SIZE = 12 }; /* bytes of a shown character, the terminator included */

/* Writes the character at text as it is to be shown; a newline and a tab are control characters, too. Returns
 * how many bytes it has of the `length` > 0 bytes. */
size_t escape_character(const char *text, size_t length, char shown[ESCAPED_SIZE]);

/* Writes the text, and a newline behind it. */
void escape_line(FILE *stream, const char *text);

/* From now on all that the process writes to standard output and standard error by stdio is escaped, but for
 * newlines and tabs, and appears line by line. */
void escape_streams(void);

/* False and errno where something that was written to standard output did not arrive. The stream stays open:
 * libraries write to it as the process ends. */
bool escape_flush_output(void);

#endif
