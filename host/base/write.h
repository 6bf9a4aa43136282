#ifndef VKWHITTED_BASE_WRITE_H
#define VKWHITTED_BASE_WRITE_H

#include <stdbool.h>
#include <stddef.h>

/* Writes all bytes, unless *error says that an earlier write failed. False where it does, or this one fails:
 * then *error is its errno. For streams' own functions: stdio tells only that a write failed, not why. */
bool write_all(int descriptor, const char *bytes, size_t size, int *error);

#endif
