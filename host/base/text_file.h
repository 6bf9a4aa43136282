#ifndef VKWHITTED_BASE_TEXT_FILE_H
#define VKWHITTED_BASE_TEXT_FILE_H

#include <stdbool.h>
#include <stddef.h>

/* The content of the file at path, with a 0 behind its last byte; the caller frees it. NULL and errno on
 * failure: EISDIR for a folder, EFBIG where there are more than `most` bytes, EINTR where the user
 * interrupted the program while it waited for a pipe or terminal. With regular_only these are refused
 * (EINVAL) instead of waited for. */
char *text_file_read(const char *path, bool regular_only, size_t most, size_t *length);

#endif
