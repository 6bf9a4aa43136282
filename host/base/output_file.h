#ifndef VKWHITTED_BASE_OUTPUT_FILE_H
#define VKWHITTED_BASE_OUTPUT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

/* A file that appears whole or not at all: it is written under a temporary name (.NAME.PROCESS.ATTEMPT) in
 * the target's directory and renamed over the target once it is safely on the disk.
 *
 * A target that is a symbolic link is followed: the file it leads to is replaced, the link stays. A
 * target that exists and is no regular file (directory, device, fifo) is refused, since nothing there
 * can be replaced as a whole; so is one without write permission, though rename() would pass over that.
 *
 * A process that is interrupted (interrupt.h) leaves nothing behind. */
struct output_file {
    const char *path; /* as given, for messages; the caller keeps it alive */
    FILE *stream;     /* write here: commit reports what fails; NULL when not open */
    char *target, *temporary;
    int descriptor;
    int error; /* errno of the first write that failed, also of one to the stream */
};

/* Nothing is left to clean up unless STATUS_DONE comes back; STATUS_UNABLE has been reported. The struct
 * stays where it is while the file is open. */
enum status output_file_open(const char *path, struct output_file *file);

/* Writes size bytes at an offset from the start of the file; false on failure, which output_file_commit()
 * reports. A file is written with this alone or without it. */
bool output_file_write_at(struct output_file *file, const void *bytes, size_t size, uint64_t offset);

/* Puts the file in place and closes it. On STATUS_UNABLE (reported) the target is as it was before. */
enum status output_file_commit(struct output_file *file);

/* Removes what was written; the target is as it was before. Does nothing to a file that is not open. */
void output_file_abandon(struct output_file *file);

/* For a failure before the work, not after it: whether output_file_open() would succeed now, and the file is
 * not claimed yet, also under another name. It is then, until it is in place: text_file.h does not read it.
 */
enum status output_file_claim(const char *path);

/* The path under which the file was claimed, or NULL: it was not. With identity from stat(). */
struct stat;
const char *output_file_claimed(const struct stat *identity);

/* Forgets all claims. */
void output_file_release(void);

#endif
