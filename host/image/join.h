#ifndef VKWHITTED_IMAGE_JOIN_H
#define VKWHITTED_IMAGE_JOIN_H

#include "image/tile.h"

/* The tiles of a picture, in files that render --tile has written: of each that is read a chunk of rows at a
 * time, so that the picture may be larger than memory. */
struct join;

/* Reads the headers of the tiles. STATUS_REFUSED where they are not all of one picture's tiles, each once:
 * what is missing, doubled or of another picture is reported. The paths must outlive it. */
enum status join_create(const char *const *paths, size_t count, struct join **join);
void join_destroy(struct join **join);

/* The joined picture and what its file is to say, but for the transfer function. */
struct image_rows join_rows(struct join *join);
struct image_metadata join_metadata(const struct join *join);

#endif
