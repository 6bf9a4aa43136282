#ifndef VKWHITTED_IMAGE_TILE_H
#define VKWHITTED_IMAGE_TILE_H

#include "image/image.h"

/* One of many parts of a picture, for one of many machines: strips of rows, dealt out in turn, so that each
 * part has some of everything that the picture shows. */
struct tile {
    unsigned number, count; /* the first is 1; 0: there is none, the picture is one */
    struct window whole;    /* the part of the picture that is dealt out */
};

enum { TILE_MOST = 65536 };

/* Which rows it has. False where there are not as many rows as tiles. */
bool tile_rows(const struct tile *tile, struct window *window, struct strips *strips);

/* The tile and the place in it that have row y of the whole. */
unsigned tile_of_row(const struct tile *tile, unsigned y, unsigned *row);

/* "3/16 of 0,0,600,400", as it stands in files. */
enum { TILE_TEXT = 64 };
void tile_print(const struct tile *tile, char text[static TILE_TEXT]);
bool tile_parse(const char *text, struct tile *tile);

#endif
