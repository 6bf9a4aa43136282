#ifndef VKWHITTED_IMAGE_FORMATS_H
#define VKWHITTED_IMAGE_FORMATS_H

#include <stdint.h>

#include "image/read.h"

/* Writers behind image_write(); each reports its failures. */
enum status image_write_png(const struct image_rows *rows, const char *path,
                            const struct image_metadata *metadata);
enum status image_write_exr(const struct image_rows *rows, const char *path,
                            const struct image_metadata *metadata);

struct png_text {
    const char *key, *text; /* Latin-1 letters only; UTF-8. A NULL text is left out. */
};

/* An 8-bit RGB picture that is made row by row. */
struct png_source {
    unsigned width, height;
    enum transfer transfer;       /* of the code values, for the file to say */
    const struct png_text *texts; /* beside that of the program */
    int text_count;
    enum status (*encode_row)(const void *context, unsigned y, uint8_t *rgb); /* 3 * width bytes */
    const void *context;
};

/* Writes the picture to a file, whole or not at all. STATUS_UNABLE (reported) where it cannot be written, or
 * what a row fails with. */
enum status png_write(const struct png_source *source, const char *path);

/* What the readers behind image_read() share. Each reports its failures, upon which the picture is the
 * caller's to destroy. */
struct read_input {
    const char *path;
    const uint8_t *bytes; /* the file's content; EXR, of which some rows are read at a time: NULL */
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
