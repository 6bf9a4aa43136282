#include "bench/error.h"

#include <math.h>
#include <stdlib.h>

#include "base/statistics.h"
#include "image/srgb.h"

static const double relative_floor = 1e-3;

static bool is_off_8bit(const struct srgb_encoder *encoder, const float *value, const double *exact)
{
    const float exact_float[3] = {(float)exact[0], (float)exact[1], (float)exact[2]};
    uint8_t code[3], exact_code[3];
    srgb_encode(encoder, value, 3, code);
    srgb_encode(encoder, exact_float, 3, exact_code);
    for (int c = 0; c < 3; ++c)
        if (abs((int)code[c] - (int)exact_code[c]) > 1)
            return true;
    return false;
}

/* The pixel's largest errors over the channels; returns the mean of their squares. */
static double measure_pixel(const struct image *image, size_t place, const double *exact, double *absolute,
                            double *relative)
{
    double squares = 0;
    *absolute = *relative = 0;
    for (size_t c = 0; c < 3; ++c) {
        size_t at = 3 * place + c;
        double error = fabs((image->rgb64 ? image->rgb64[at] : (double)image->rgb[at]) - exact[c]);
        error = isnan(error) ? INFINITY : error;
        *absolute = fmax(*absolute, error);
        *relative = fmax(*relative, error / fmax(fabs(exact[c]), relative_floor));
        squares += error * error;
    }
    return squares / 3;
}

enum status bench_error_measure(const struct image *image, const struct ground_truth *truth,
                                struct bench_error *error)
{
    size_t count = pixel_grid_count(&truth->grid);
    double *absolute = calloc(2 * count, sizeof *absolute);
    double sum = 0, sum_of_squares = 0; /* of the pixels' mean squares */
    struct srgb_encoder encoder;
    *error = (struct bench_error){0};
    if (!absolute) {
        log_error("no memory for the errors of %zu pixels", count);
        return STATUS_UNABLE;
    }
    double *relative = absolute + count;
    srgb_encoder_init(&encoder);
    for (size_t i = 0; i < count; ++i) {
        size_t place = pixel_grid_place(&truth->grid, i, image->width);
        const double *exact = &truth->rgb[3 * i];
        double mean_square = measure_pixel(image, place, exact, &absolute[i], &relative[i]);
        sum += mean_square;
        sum_of_squares += mean_square * mean_square;
        error->pixels_off_8bit += is_off_8bit(&encoder, &image->rgb[3 * place], exact);
    }
    sort_doubles(absolute, count);
    sort_doubles(relative, count);
    double n = (double)count, variance = sum_of_squares / n - (sum / n) * (sum / n);
    error->max = absolute[count - 1];
    error->rmse = sqrt(sum / n);
    error->rmse_uncertainty = sum > 0 ? sqrt(fmax(variance, 0) / n) / (2 * error->rmse) : 0;
    error->absolute_999 = sorted_quantile(absolute, count, 0.999);
    error->relative_median = sorted_quantile(relative, count, 0.5);
    error->relative_999 = sorted_quantile(relative, count, 0.999);
    free(absolute);
    return STATUS_DONE;
}
