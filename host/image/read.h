#ifndef VKWHITTED_IMAGE_READ_H
#define VKWHITTED_IMAGE_READ_H

#include "image/image.h"

/* What any program's picture file says of linear radiance: a value that the file's format has rounded lies
 * between two. */
struct value_range {
    float low, high;
};

struct read_image {
    unsigned width, height;
    struct value_range *rgb; /* in struct image's order */
};

/* The picture that a file is expected to hold. */
struct image_wanted {
    struct window window;   /* of the whole picture */
    enum transfer transfer; /* of PNG's code values */
};

/* Reads a picture file of the wanted size; its suffix says the format:
 * .pfm, colour: as it is.
 * .exr, channels R, G and B of the first part, 16 or 32 bits, scanlines or tiles, compressed without loss:
 * 16-bit values were rounded to nearest. The data window is the display window, or the wanted part of it.
 * .png, colour or grey of 8 or 16 bits: a code value stands for all between the two beside it, for programs
 * round them up, down and to nearest; the lowest and the highest also for what was clipped. What its alpha
 * channel says is left out.
 *
 * On STATUS_DONE the caller frees the picture with read_image_destroy(); otherwise it is empty and the reason
 * reported: STATUS_REFUSED for a file that is not such a picture, STATUS_UNABLE where it cannot be read. */
enum status image_read(const char *path, const struct image_wanted *wanted, struct read_image *picture);

void read_image_destroy(struct read_image *picture);

#endif
