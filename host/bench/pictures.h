#ifndef VKWHITTED_BENCH_PICTURES_H
#define VKWHITTED_BENCH_PICTURES_H

#include <jansson.h>

#include "base/status.h"
#include "image/image.h"

/* The picture as "render" and, with a reference, where it differs from that as "heatmap" (see compare.h),
 * each a PNG in base64, in an object that the caller frees. On failure (reported) *pictures is NULL. */
enum status bench_pictures(const struct image *image, const struct image *reference, json_t **pictures);

#endif
