#include "image/tile.h"

#include <stdio.h>
#include <string.h>

/* Rows of a strip: so few that a tile gets 16 strips at least, if there are as many rows. The work of tiles
 * then differs by 5 %; more strips would be more even, and cost more dispatches. */
static unsigned strip_rows(const struct tile *tile)
{
    enum { STRIPS = 16 };
    const unsigned rows = tile->whole.height / (STRIPS * tile->count);
    return rows > 0 ? rows : 1;
}

bool tile_rows(const struct tile *tile, struct window *window, struct strips *strips)
{
    const unsigned rows = strip_rows(tile), turn = rows * tile->count, first = rows * (tile->number - 1);
    const unsigned turns = tile->whole.height / turn, rest = tile->whole.height % turn;
    const unsigned of_rest = rest <= first ? 0 : rest - first < rows ? rest - first : rows;
    *strips = (struct strips){rows, turn - rows};
    *window = tile->whole;
    window->y += first;
    window->height = turns * rows + of_rest;
    return tile->count <= tile->whole.height;
}

unsigned tile_of_row(const struct tile *tile, unsigned y, unsigned *row)
{
    const unsigned rows = strip_rows(tile), turn = rows * tile->count;
    *row = y / turn * rows + y % rows;
    return y % turn / rows + 1;
}

void tile_print(const struct tile *tile, char text[static TILE_TEXT])
{
    snprintf(text, TILE_TEXT, "%u/%u of %u,%u,%u,%u", tile->number, tile->count, tile->whole.x, tile->whole.y,
             tile->whole.width, tile->whole.height);
}

bool tile_parse(const char *text, struct tile *tile)
{
    char again[TILE_TEXT];
    struct window *whole = &tile->whole;
    if (sscanf(text, "%u/%u of %u,%u,%u,%u", &tile->number, &tile->count, &whole->x, &whole->y, &whole->width,
               &whole->height) != 6)
        return false;
    tile_print(tile, again);
    return strcmp(text, again) == 0 && tile->number >= 1 && tile->number <= tile->count &&
           tile->count <= whole->height && whole->width >= 1 && whole->x <= TILE_MOST &&
           whole->y <= TILE_MOST && whole->width <= TILE_MOST && whole->height <= TILE_MOST;
}
