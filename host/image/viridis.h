#ifndef VKWHITTED_IMAGE_VIRIDIS_H
#define VKWHITTED_IMAGE_VIRIDIS_H

#include <stdint.h>

/* The colour of level in [0, 1], clamped: viridis (Stefan van der Walt and Nathaniel Smith, CC0) at its
 * quarters; perceived lightness grows evenly along it. */
void viridis(double level, uint8_t *rgb);

#endif
