#ifndef VKWHITTED_WATCH_FIT_H
#define VKWHITTED_WATCH_FIT_H

#include <stdbool.h>

/* A picture scaled to fit a window, its aspect kept, in the middle. */

/* A picture of 8-bit RGBA, row 0 on top, without padding. */
struct rgba_picture {
    unsigned width, height; /* at least 1 */
    unsigned char *rgba;
};

/* Where in a window of width x height a picture fits; at least one pixel, unless the window is empty. */
struct fit {
    unsigned x, y, width, height;
};
struct fit fit_picture(const struct rgba_picture *picture, unsigned width, unsigned height);

/* Fills a window of 32-bit pixels: black, and the picture where it fits. Where the picture is as large as its
 * place, its bytes are copied; enlarged, its pixels are; reduced, each pixel is the mean of the bytes that
 * fall on it. Alpha becomes 255. blue_first: the window's pixels are BGRA. */
void fit_draw(const struct rgba_picture *picture, unsigned width, unsigned height, bool blue_first,
              unsigned char *pixels);

#endif
