#ifndef VKWHITTED_IMAGE_FILE_H
#define VKWHITTED_IMAGE_FILE_H

#include "base/status.h"
#include "image/image.h"

enum image_format { IMAGE_FORMAT_UNKNOWN, IMAGE_FORMAT_PNG, IMAGE_FORMAT_EXR, IMAGE_FORMAT_PFM };

/* The format that a path's suffix names, in either case; IMAGE_FORMAT_UNKNOWN (reported) for any other. */
enum image_format image_format_of(const char *path);

/* Writes the picture in the format of the path's suffix, whole or not at all (see output_file.h):
 * .png 8-bit RGB, .exr 32-bit float, ZIP, .pfm 32-bit float. STATUS_REFUSED for an unknown suffix,
 * STATUS_UNABLE where the file cannot be written; both reported. Needs memory for a few rows only. */
enum status image_write(const struct image *image, const char *path, const struct image_metadata *metadata);

/* Whether image_write() could begin now: known suffix, writable place. Reports and returns as it does. */
enum status image_write_check(const char *path);

#endif
