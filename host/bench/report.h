#ifndef VKWHITTED_BENCH_REPORT_H
#define VKWHITTED_BENCH_REPORT_H

#include <jansson.h>

#include "image/image.h"

/* The picture as "render" and, with a reference, where it differs from that as "heatmap" (see heatmap.h),
 * each a PNG in base64, in an object that the caller frees. On failure (reported) *pictures is NULL. */
enum status report_pictures(const struct image *image, const struct image *reference, json_t **pictures);

/* Writes the bench document as one HTML page that needs nothing else: report.html with the document in it.
 * The file appears whole or not at all; STATUS_UNABLE has been reported. */
enum status report_write(const json_t *document, const char *path);

#endif
