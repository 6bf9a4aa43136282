#ifndef VKWHITTED_BASE_TEXT_FILE_H
#define VKWHITTED_BASE_TEXT_FILE_H

#include <stddef.h>

/* The content of the regular file at path, with a 0 behind its last byte; the caller frees it. NULL and errno
 * on failure: EINVAL where it is no regular file, EFBIG where it has more than `most` bytes. */
char *file_text_read(const char *path, size_t most, size_t *length);

#endif
