#ifndef VKWHITTED_BASE_TEXT_FILE_H
#define VKWHITTED_BASE_TEXT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "base/status.h"

/* All input files are opened here. */

/* Opens a file for reading, without waiting for a pipe's writer. -1 and errno on failure: EISDIR for a
 * folder, EBUSY for a file that is to be written (output_file_claim()), and with regular_only EINVAL for a
 * pipe or device. */
int input_file_open(const char *path, bool regular_only);

/* Reads as much as there is, up to size bytes; less at the end of the file, -1 and errno on failure. Waits
 * for what comes through a pipe. */
ssize_t input_file_read(int file, void *bytes, size_t size);

/* The content of the file at path, with a 0 behind its last byte; the caller frees it. NULL and errno on
 * failure: as above, and EFBIG where there are more than `most` bytes. */
char *text_file_read(const char *path, bool regular_only, size_t most, size_t *length);

/* What such an errno is called in a message, and whether it is the user's doing, STATUS_REFUSED, or the
 * machine's, STATUS_UNABLE. */
const char *input_file_problem(int error);
enum status input_file_status(int error);

/* Reports that the file cannot be read for errno's reason; the status that comes of it. */
enum status input_file_refuse(const char *path);

#endif
