#ifndef VKWHITTED_BENCH_PIXEL_GRID_H
#define VKWHITTED_BENCH_PIXEL_GRID_H

#include "base/progress.h"
#include "tracer/render.h"

/* Every step-th pixel of a picture in both directions. */
struct pixel_grid {
    unsigned step, first, columns, rows;
};

/* The finest grid over the picture with about so many pixels at most, 1 at least. */
struct pixel_grid pixel_grid_fitting(unsigned width, unsigned height, double most_pixels);

static inline size_t pixel_grid_count(const struct pixel_grid *grid)
{
    return (size_t)grid->columns * grid->rows;
}

/* The index in the picture of the grid's pixel. */
static inline size_t pixel_grid_place(const struct pixel_grid *grid, size_t pixel, unsigned picture_width)
{
    size_t x = grid->first + pixel % grid->columns * grid->step;
    size_t y = grid->first + pixel / grid->columns * grid->step;
    return y * picture_width + x;
}

/* What the reference makes of the grid's pixels, row by row. */
struct grid_pixels {
    double *rgb;                                /* 3 a pixel */
    uint32_t *signatures;                       /* NULL: not wanted */
    struct reference_explanation *explanations; /* in quad, instead of all others; NULL: not wanted */
    struct reference_rays rays;                 /* added to */
};

/* Renders the grid's pixels with the reference on all processors. Advances progress, if not NULL, by `share`
 * in all. STATUS_INTERRUPTED after Ctrl-C. */
enum status pixel_grid_render(const struct packed_scene *scene, enum precision precision,
                              const struct pixel_grid *grid, struct grid_pixels *pixels,
                              struct progress *progress, double share);

#endif
