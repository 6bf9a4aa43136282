#include "bench/ground_truth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/statistics.h"
#include "image/srgb.h"

enum { ALL_BOUNCES = 64, STRIDE_OF_BOUNCES = 4 };

static const double most_rays_a_pixel = 2000, relative_floor = 1e-3;

enum status ground_truth_bounces(const struct packed_scene *packed, unsigned *most)
{
    struct packed_scene pilot = *packed;
    *most = (unsigned)packed->max_bounces;
    while (*most < ALL_BOUNCES) {
        struct reference_rays rays;
        double pixels;
        unsigned next = *most + STRIDE_OF_BOUNCES;
        pilot.max_bounces = (int)(next < ALL_BOUNCES ? next : ALL_BOUNCES);
        enum status status = grid_count_rays(&pilot, &rays, &pixels);
        if (status != STATUS_DONE || (double)rays.secondary > most_rays_a_pixel * pixels)
            return status;
        *most = (unsigned)pilot.max_bounces;
    }
    return STATUS_DONE;
}

enum status ground_truth_create(const struct scene *scene, struct picture_settings settings,
                                enum truth_kind kind, const struct truth_effort *effort,
                                struct progress *progress, double share, struct ground_truth *truth)
{
    struct packed_scene packed;
    enum grid_output output = kind == TRUTH_EXACT ? GRID_QUAD : GRID_DOUBLE;
    char what[100], where[100] = "every pixel";
    *truth = (struct ground_truth){0};
    if (kind == TRUTH_OF_SAMPLES) {
        settings.samples = effort->samples;
        settings.light_samples = 1; /* of each pixel sample: together as many as those */
        snprintf(what, sizeof what, "double with %u samples a pixel", settings.samples);
    } else if (kind == TRUTH_OF_LIGHTS) {
        settings.light_samples = effort->samples;
        snprintf(what, sizeof what, "double with %u bounces and %u light samples", settings.max_bounces,
                 settings.light_samples);
    } else {
        snprintf(what, sizeof what, "quad (binary128) with %u bounces", settings.max_bounces);
    }
    enum status status = pack_scene(scene, &settings, &packed);
    if (status != STATUS_DONE)
        return status;
    status = grid_render(&packed, output, kind == TRUTH_EXACT ? effort->quad : effort->with_double, progress,
                         share, &truth->pixels);
    pack_destroy(&packed);
    const struct pixel_grid *grid = &truth->pixels.grid;
    if (grid->step > 1)
        snprintf(where, sizeof where, "%zu pixels: one in %u, both ways", pixel_grid_count(grid), grid->step);
    snprintf(truth->text, sizeof truth->text, "the reference in %s, at %s", what, where);
    return status;
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
    size_t count = pixel_grid_count(&truth->pixels.grid);
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
        size_t place = pixel_grid_place(&truth->pixels.grid, i, image->width);
        const double *exact = &truth->pixels.rgb[3 * i];
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
