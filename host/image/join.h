#ifndef VKWHITTED_IMAGE_JOIN_H
#define VKWHITTED_IMAGE_JOIN_H

#include "image/image.h"

/* Writes the picture whose tiles are in these files, as render --tile has written them, to each of the
 * outputs, each whole or not at all. Tiles are read a chunk of rows at a time, so the picture may be larger
 * than memory. STATUS_REFUSED where the files are not all of one picture's tiles, each once: what is missing,
 * doubled or of another picture is reported. */
enum status join_tiles(const char *const *paths, size_t count, const char *const *outputs,
                       size_t output_count, enum transfer transfer);

#endif
