#ifndef VKWHITTED_BENCH_GROUND_TRUTH_H
#define VKWHITTED_BENCH_GROUND_TRUTH_H

#include "bench/pixel_grid.h"
#include "scene/pack.h"

/* What errors are measured against: the reference at high precision, as far as it is affordable, which may be
 * at some of the pixels only. What is computed depends on the scene and its size, not on the machine. */
struct ground_truth {
    struct grid_pixels pixels;
    char text[200]; /* what it is, for people */
};

/* How much work truths may be: rays times objects. */
struct truth_effort {
    double quad, with_double, explained; /* explained: quad with the error analysis */
    unsigned samples;                    /* of what is sampled */
};

/* The most bounces, at least the scene's and otherwise at most 64, with which rays do not multiply beyond
 * reason. */
enum status ground_truth_bounces(const struct packed_scene *packed, unsigned *most);

/* Which picture is true: that of the settings in quad; in double where lights are sampled, with converged
 * light samples; or in double with converged pixel samples. */
enum truth_kind { TRUTH_EXACT, TRUTH_OF_LIGHTS, TRUTH_OF_SAMPLES };

/* Renders the truth, and advances progress by `share`. On failure (reported) the truth is empty; otherwise
 * the caller frees it. */
enum status ground_truth_create(const struct scene *scene, struct picture_settings settings,
                                enum truth_kind kind, const struct truth_effort *effort,
                                struct progress *progress, double share, struct ground_truth *truth);

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
