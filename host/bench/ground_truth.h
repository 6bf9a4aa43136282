#ifndef VKWHITTED_BENCH_GROUND_TRUTH_H
#define VKWHITTED_BENCH_GROUND_TRUTH_H

#include "base/progress.h"
#include "scene/pack.h"
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
    struct reference_rays rays;
};

void grid_pixels_destroy(struct grid_pixels *pixels);

/* What errors are measured against: the reference at high precision, as far as it is affordable, which may be
 * at some of the pixels only. What is computed depends on the scene and its size, not on the machine. */
struct ground_truth {
    struct grid_pixels pixels;
    char text[200]; /* what it is, for people */
};

/* The most bounces, at least the scene's and otherwise at most 64, with which rays do not multiply beyond
 * reason. */
enum status ground_truth_bounces(const struct packed_scene *packed, unsigned *most);

/* Which picture is true: that of the settings in quad; in double where lights are sampled, with converged
 * light samples; or in double with converged pixel samples. */
enum truth_kind { TRUTH_EXACT, TRUTH_OF_LIGHTS, TRUTH_OF_SAMPLES };

/* Renders the truth with the reference on all processors, at the finest grid of pixels that is about so much
 * work, in rays times objects. Advances progress by `share` in all. packed: the scene with other settings, or
 * NULL. On STATUS_DONE the caller frees the pixels; otherwise they are empty, and the reason is reported. */
enum status ground_truth_create(const struct scene *scene, const struct packed_scene *packed,
                                struct picture_settings settings, enum truth_kind kind, double work,
                                struct progress *progress, unsigned share, struct ground_truth *truth);

/* How far a picture is from the truth, at the truth's pixels. Infinite where a value is not finite. A pixel's
 * error is the largest over its channels; a relative error is |value - truth| / max(|truth|, 1e-3). */
struct bench_error {
    double max, rmse;        /* over all channel values, linear radiance */
    double rmse_uncertainty; /* standard error of rmse, were the pixels drawn at random */
    double absolute_999;     /* 99.9 % of the pixels are within it */
    double relative_median, relative_999;
    size_t pixels_off_8bit; /* with a channel off by more than one step of 8-bit sRGB */
};

/* The picture is whole: the truth's grid is one over it. STATUS_UNABLE (reported) without memory. */
enum status bench_error_measure(const struct image *image, const struct ground_truth *truth,
                                struct bench_error *error);

#endif
