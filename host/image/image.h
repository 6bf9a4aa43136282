#ifndef VKWHITTED_IMAGE_IMAGE_H
#define VKWHITTED_IMAGE_IMAGE_H

#include <stddef.h>

#include "base/status.h"

/* Linear RGB radiance, row 0 on top, pixel (x, y) channel c at rgb[(y * width + x) * 3 + c]. */
struct image {
    unsigned width, height;
    float *rgb;
    double *rgb64; /* the same before rounding to float, where that is wanted; otherwise NULL */
    float
        *truncation; /* how far a pixel is from the picture with all bounces at most, where wanted; or NULL */
};

/* From linear light to 8-bit code values. */
enum transfer { TRANSFER_SRGB, TRANSFER_LINEAR };

/* What a file says about its picture, as far as its format can: PNG and EXR hold all but the transfer
 * function as the texts or attributes "scene", "device", "precision" and "maxBounces"; PFM holds none.
 * The transfer function matters to PNG alone, the others are linear. A string may be NULL. */
struct image_metadata {
    enum transfer transfer;
    const char *scene, *device, *precision;
    unsigned max_bounces;
};

/* A black image; STATUS_UNABLE (reported) if the machine's memory cannot hold it. */
enum status image_create(unsigned width, unsigned height, struct image *image);

/* Gives a black image room for double precision; STATUS_UNABLE (reported) without memory. */
enum status image_widen(struct image *image);
void image_destroy(struct image *image);

#endif
