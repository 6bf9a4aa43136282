#ifndef VKWHITTED_BENCH_ERROR_H
#define VKWHITTED_BENCH_ERROR_H

#include "bench/ground_truth.h"
#include "image/image.h"

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
