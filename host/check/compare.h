#ifndef VKWHITTED_CHECK_COMPARE_H
#define VKWHITTED_CHECK_COMPARE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "image/image.h"

/* Two channel values a and b agree if |a - b| <= absolute + relative * max(|a|, |b|), or if both are NaN.
 * An infinity agrees with nothing but itself, NaN with nothing but NaN. */
struct tolerance {
    double absolute, relative;
};

struct comparison {
    size_t differing;     /* pixels with a channel that does not agree */
    size_t bit_differing; /* pixels with a channel that is not the same bit for bit */

    /* The worst channel value: the largest |a - b| among those that do not agree, or where all agree, among
     * those that are not the same bits; the first of equals. The error is infinite where just one side is
     * NaN, or a side is infinite; it is 0 between -0 and +0 and between NaNs of different bits. All 0 where
     * the pictures are the same bits. */
    double max_error;
    unsigned x, y, channel;
};

/* Compares two pictures; bit for bit if tolerance is NULL: then -0 and +0 do not agree, and NaNs agree only
 * if they are the same bits. STATUS_DONE if all pixels agree, otherwise STATUS_DIFFERS, without a message;
 * STATUS_REFUSED (reported, *comparison all 0) where the sizes differ. */
enum status image_compare(const struct image *a, const struct image *b, const struct tolerance *tolerance,
                          struct comparison *comparison);

/* The 8-bit colour of the difference between two pixels in the picture that heatmap_write() writes. */
void heatmap_color(const float *a, const float *b, uint8_t *rgb);

/* Writes an 8-bit PNG (whole or not at all, see output_file.h) that shows where two pictures differ: each
 * pixel its largest relative error over the channels, |a - b| / max(|a|, |b|), on a logarithmic scale in the
 * colours of viridis. Dark violet is 2^-24 (half a unit in the last place of a float) or less, blue 2^-18,
 * teal 2^-12, green 2^-6, yellow 1 or more. Black: the same bits; white: not the same bits, and not finite
 * on one side at least.
 * STATUS_REFUSED (reported) where the sizes differ, STATUS_UNABLE (reported) where it cannot be written. */
enum status heatmap_write(const struct image *a, const struct image *b, const char *path);

#endif
