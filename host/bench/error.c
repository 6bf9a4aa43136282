#include "bench/error.h"

#include <math.h>
#include <stdlib.h>

#include "base/statistics.h"
#include "image/srgb.h"

static const double relative_floor = 1e-3;

static double value_at(const struct image *image, size_t index)
{
    return image->rgb64 ? image->rgb64[index] : (double)image->rgb[index];
}

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

/* Sums of squared errors of pixels, and of their squares. */
struct moments {
    double squares, fourth_powers;
};

static void measure_pixel(const struct image *image, size_t place, const double *exact, double *absolute,
                          double *relative, struct moments *moments)
{
    double squares = 0;
    *absolute = *relative = 0;
    for (size_t c = 0; c < 3; ++c) {
        double error = fabs(value_at(image, 3 * place + c) - exact[c]);
        error = isnan(error) ? INFINITY : error;
        *absolute = fmax(*absolute, error);
        *relative = fmax(*relative, error / fmax(fabs(exact[c]), relative_floor));
        squares += error * error / 3;
    }
    moments->squares += squares;
    moments->fourth_powers += squares * squares;
}

enum status bench_error_measure(const struct image *image, const struct ground_truth *truth,
                                struct bench_error *error)
{
    size_t count = pixel_grid_count(&truth->grid);
    double *absolute = calloc(count, sizeof *absolute), *relative = calloc(count, sizeof *relative);
    struct srgb_encoder *encoder = malloc(sizeof *encoder);
    struct moments moments = {0, 0};
    *error = (struct bench_error){0};
    if (!absolute || !relative || !encoder) {
        log_error("no memory for the errors of %zu pixels", count);
        free(absolute);
        free(relative);
        free(encoder);
        return STATUS_UNABLE;
    }
    srgb_encoder_init(encoder);
    for (size_t i = 0; i < count; ++i) {
        size_t place = pixel_grid_place(&truth->grid, i, image->width);
        const double *exact = &truth->rgb[3 * i];
        measure_pixel(image, place, exact, &absolute[i], &relative[i], &moments);
        error->pixels_off_8bit += is_off_8bit(encoder, &image->rgb[3 * place], exact);
    }
    sort_doubles(absolute, count);
    sort_doubles(relative, count);
    double mean_square = moments.squares / (double)count;
    double variance = moments.fourth_powers / (double)count - mean_square * mean_square;
    error->max = absolute[count - 1];
    error->rmse = sqrt(mean_square);
    error->rmse_uncertainty =
        error->rmse > 0 ? sqrt(fmax(variance, 0) / (double)count) / (2 * error->rmse) : 0;
    error->absolute_999 = sorted_quantile(absolute, count, 0.999);
    error->relative_median = sorted_quantile(relative, count, 0.5);
    error->relative_999 = sorted_quantile(relative, count, 0.999);
    free(absolute);
    free(relative);
    free(encoder);
    return STATUS_DONE;
}
