#ifndef VKWHITTED_CHECK_SPOT_CHECK_H
#define VKWHITTED_CHECK_SPOT_CHECK_H

#include "tracer/render.h"

/* Compares some pixels of a device's exact picture with the reference's, bit for bit: the probe has judged
 * the device's arithmetic in another shader. One pixel in 1024, 16 at most, so that it costs little beside
 * the picture. STATUS_UNABLE (reported) where one differs. */
enum status spot_check(const struct render_plan *plan, const struct image *image, const char *device);

#endif
