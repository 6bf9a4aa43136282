#ifndef VKWHITTED_CHECK_COMPARE_H
#define VKWHITTED_CHECK_COMPARE_H

#include "base/json.h"
#include "image/image.h"

/* Two channel values a and b agree if |a - b| <= absolute + relative * max(|a|, |b|), or if both are NaN.
 * An infinity agrees with nothing but itself, NaN with nothing but NaN. */
struct tolerance {
    double absolute, relative;
};

struct comparison {
    unsigned width, height;
    size_t differing;     /* pixels with a channel that does not agree */
    size_t bit_differing; /* pixels with a channel that is not the same bit for bit */

    /* The worst channel value: the largest |a - b| among those that do not agree, or where all agree, among
     * those that are not the same bits; the first of equals. The error is infinite where just one side is
     * NaN, or a side is infinite; it is 0 between -0 and +0 and between NaNs of different bits. All 0 where
     * the pictures are the same bits. */
    double max_error;
    unsigned x, y, channel;
    unsigned first_x, first_y; /* the first pixel that does not agree, row by row; 0 where all agree */
};

/* Compares two pictures of the same size and precision, in double where they have it; bit for bit if
 * tolerance is NULL: then -0 and +0 do not agree, and NaNs agree only if they are the same bits. A picture
 * has a pixel at least. */
struct comparison image_compare(const struct image *a, const struct image *b,
                                const struct tolerance *tolerance);

/* Prints in a line how a scene's pictures compare, of which so many pixels are allowed to differ. */
void comparison_print(const struct comparison *comparison, const char *scene, size_t allowed);

/* The same as a JSON object; NULL without memory or where the scene's name is not UTF-8. */
json_t *comparison_json(const struct comparison *comparison, const char *scene, size_t allowed);

#endif
