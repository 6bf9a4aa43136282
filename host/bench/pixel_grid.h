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

/* What the reference makes of a grid's pixels, row by row. */
struct grid_pixels {
    struct pixel_grid grid;
    double *rgb; /* 3 a pixel */
    uint32_t *signatures;
    struct reference_explanation *explanations; /* instead of both others */
    struct reference_rays rays;
};

enum grid_output { GRID_FLOAT, GRID_DOUBLE, GRID_QUAD, GRID_EXPLAINED_QUAD };

/* Renders pixels of the picture with the reference on all processors: the finest grid that is about so much
 * work, in rays times objects. Advances progress by `share` in all. On STATUS_DONE the caller frees the
 * pixels; otherwise they are empty, and the reason is reported, except for STATUS_INTERRUPTED. */
enum status grid_render(const struct packed_scene *scene, enum grid_output output, double work,
                        struct progress *progress, double share, struct grid_pixels *pixels);
void grid_pixels_destroy(struct grid_pixels *pixels);

/* Counts the rays of some of the picture's pixels, with one sample of everything. */
enum status grid_count_rays(const struct packed_scene *scene, struct reference_rays *rays, double *pixels);

#endif
