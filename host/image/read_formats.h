#ifndef VKWHITTED_IMAGE_READ_FORMATS_H
#define VKWHITTED_IMAGE_READ_FORMATS_H

#include <stdbool.h>
#include <stdint.h>

#include "image/read.h"

/* What the readers behind image_read() share. Each reports its failures. */
struct read_input {
    const char *path; /* for messages */
    const uint8_t *bytes;
    size_t size;
    const struct image_wanted *wanted;
};

enum status image_read_pfm(const struct read_input *input, struct read_image *picture);
enum status image_read_png(const struct read_input *input, struct read_image *picture);
enum status image_read_exr(const struct read_input *input, struct read_image *picture);

/* Gives an empty picture its room. STATUS_REFUSED where the file's size is not the wanted one, STATUS_UNABLE
 * without memory. */
enum status read_image_create(const struct read_input *input, unsigned long width, unsigned long height,
                              struct read_image *picture);

#endif
