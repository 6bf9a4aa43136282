#ifndef VKWHITTED_CHECK_HEATMAP_H
#define VKWHITTED_CHECK_HEATMAP_H

#include <stdint.h>

#include "image/image.h"

/* The 8-bit colour of a relative error on a logarithmic scale: dark violet is 2^-24 (half a unit in the last
 * place of a float) or less, blue 2^-18, teal 2^-12, green 2^-6, yellow 1 or more. This is viridis (Stefan
 * van der Walt and Nathaniel Smith, CC0) at its quarters; perceived lightness grows evenly along it. */
void error_color(double relative_error, uint8_t *rgb);

/* A picture of how right another one is. */
struct heatmap {
    unsigned width, height;
    const char *description; /* which the file says, too */
    void (*color)(const void *context, unsigned x, unsigned y, uint8_t rgb[static 3]);
    const void *context;
};

/* Writes an 8-bit PNG, whole or not at all. STATUS_UNABLE (reported) where it cannot be written. */
enum status heatmap_write(const struct heatmap *heatmap, const char *path);

/* The colour of the difference between two pixels: of the largest relative error over the channels,
 * |a - b| / max(|a|, |b|). Black: the same bits; white: not the same bits, and not finite on one side at
 * least. */
void heatmap_color(const float *a, const float *b, uint8_t *rgb);

/* These colours for pictures of the same size; the pair is the context. */
struct image_pair {
    const struct image *a, *b;
};
struct heatmap difference_heatmap(const struct image_pair *pair);

#endif
