#include "bench/ground_truth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/statistics.h"
#include "image/transfer.h"
#include "tracer/reference_scene.h"

enum { PILOT_PIXELS = 300, ALL_BOUNCES = 64, STRIDE_OF_BOUNCES = 4, CONVERGED_SAMPLES = 65536 };

static const double most_rays_a_pixel = 2000, relative_floor = 1e-3;

struct pixel_grid pixel_grid_fitting(unsigned width, unsigned height, double most_pixels)
{
    double step = ceil(sqrt((double)width * height / fmax(most_pixels, 1)));
    struct pixel_grid grid = {.step = (unsigned)fmax(1, fmin(step, fmin(width, height)))};
    grid.first = (grid.step - 1) / 2;
    grid.columns = (width - grid.first + grid.step - 1) / grid.step;
    grid.rows = (height - grid.first + grid.step - 1) / grid.step;
    return grid;
}

static struct reference_rays render_pixel(const struct packed_scene *scene, enum precision precision,
                                          size_t pixel, const struct grid_pixels *pixels)
{
    static reference_tracer *const tracers[] = {reference_trace_float, reference_trace_double,
                                                reference_trace_quad};
    const int place = (int)pixel_grid_place(&pixels->grid, pixel, (unsigned)scene->width);
    const struct reference_pixel traced =
        tracers[precision](scene, place % scene->width, place / scene->width, NULL);
    memcpy(&pixels->rgb[3 * pixel], traced.rgb, sizeof traced.rgb);
    return traced.rays;
}

/* Renders the pixels of pixels->grid. Without a share, progress may be NULL. */
static enum status render(const struct packed_scene *scene, enum precision precision,
                          struct progress *progress, unsigned share, struct grid_pixels *pixels)
{
    const size_t count = pixel_grid_count(&pixels->grid);
    size_t done = 0;
    pixels->rgb = calloc(count, 3 * sizeof *pixels->rgb);
    if (!pixels->rgb) {
        log_error("no memory for %zu pixels of the reference", count);
        grid_pixels_destroy(pixels);
        return STATUS_UNABLE;
    }
#pragma omp parallel for schedule(dynamic)
    for (size_t i = 0; i < count; ++i) {
        struct reference_rays rays = render_pixel(scene, precision, i, pixels);
#pragma omp critical
        {
            rays_add(&pixels->rays, rays);
            size_t before = share * done / count, now = share * ++done / count;
            if (now > before)
                progress_advance(progress, now - before);
        }
    }
    return STATUS_DONE;
}

/* What a ray costs, in spheres that are looped over: a walk through the tree looks at some 16 balls and
 * spheres a level, which are not at hand. */
static double objects_a_ray(const struct packed_scene *scene)
{
    int many = scene->sphere_count - scene->looped_spheres;
    return scene->looped_spheres + scene->plane_count + 1 + (many > 0 ? 32 * log2(many + 1.0) : 0);
}

/* Estimates by some of the picture's pixels, with one sample of everything: secondary rays a pixel, and rays
 * times objects a pixel with all samples. */
static enum status estimate(const struct packed_scene *scene, double *secondary, double *work)
{
    struct packed_scene pilot = *scene;
    struct grid_pixels result = {
        .grid = pixel_grid_fitting((unsigned)scene->width, (unsigned)scene->height, PILOT_PIXELS)};
    const struct reference_rays *rays = &result.rays;
    double lights = scene->quad_light_count > 0 ? scene->light_samples : 1;
    pilot.samples = pilot.light_samples = 1;
    enum status status = render(&pilot, PRECISION_FLOAT, NULL, 0, &result);
    if (status != STATUS_DONE)
        return status;
    double pixels = (double)pixel_grid_count(&result.grid);
    *secondary = (double)rays->secondary / pixels;
    *work = ((double)(rays->primary + rays->secondary) + (double)rays->shadow * lights) * scene->samples *
            objects_a_ray(scene) / pixels;
    grid_pixels_destroy(&result);
    return STATUS_DONE;
}

/* Renders pixels of the picture on all processors: the finest grid that is about so much work, in rays times
 * objects. On failure they are empty. */
static enum status render_within(const struct packed_scene *packed, enum precision precision, double work,
                                 struct progress *progress, unsigned share, struct grid_pixels *pixels)
{
    double secondary, work_a_pixel;
    struct packed_scene scene;
    *pixels = (struct grid_pixels){0};
    enum status status = reference_scene(packed, 0, &scene);
    if (status == STATUS_DONE)
        status = estimate(&scene, &secondary, &work_a_pixel);
    if (status == STATUS_DONE) {
        pixels->grid =
            pixel_grid_fitting((unsigned)packed->width, (unsigned)packed->height, work / work_a_pixel);
        status = render(&scene, precision, progress, share, pixels);
    }
    return status;
}

void grid_pixels_destroy(struct grid_pixels *pixels)
{
    free(pixels->rgb);
    *pixels = (struct grid_pixels){0};
}

enum status ground_truth_bounces(const struct packed_scene *packed, unsigned *most)
{
    struct packed_scene scene;
    enum status status = reference_scene(packed, 0, &scene);
    *most = (unsigned)packed->max_bounces;
    while (status == STATUS_DONE && *most < ALL_BOUNCES) {
        double secondary, work;
        unsigned next = *most + STRIDE_OF_BOUNCES;
        scene.max_bounces = (int)(next < ALL_BOUNCES ? next : ALL_BOUNCES);
        status = estimate(&scene, &secondary, &work);
        if (status != STATUS_DONE || secondary > most_rays_a_pixel)
            break;
        *most = (unsigned)scene.max_bounces;
    }
    return status;
}

enum status ground_truth_create(const struct scene *scene, const struct packed_scene *other,
                                struct picture_settings settings, enum truth_kind kind, double work,
                                struct progress *progress, unsigned share, struct ground_truth *truth)
{
    struct packed_scene packed;
    char what[100], where[100] = "every pixel";
    *truth = (struct ground_truth){0};
    if (kind == TRUTH_OF_SAMPLES) {
        settings.samples = CONVERGED_SAMPLES;
        settings.light_samples = 1; /* of each pixel sample: together as many as those */
        snprintf(what, sizeof what, "double with %u samples a pixel", settings.samples);
    } else if (kind == TRUTH_OF_LIGHTS) {
        settings.light_samples = CONVERGED_SAMPLES;
        snprintf(what, sizeof what, "double with %u bounces and %u light samples", settings.max_bounces,
                 settings.light_samples);
    } else {
        snprintf(what, sizeof what, "quad (binary128) with %u bounces", settings.max_bounces);
    }
    enum status status = pack_scene(other, scene, &settings, &packed);
    if (status != STATUS_DONE)
        return status;
    status = render_within(&packed, kind == TRUTH_EXACT ? PRECISION_QUAD : PRECISION_DOUBLE, work, progress,
                           share, &truth->pixels);
    pack_destroy(&packed);
    const struct pixel_grid *grid = &truth->pixels.grid;
    if (grid->step > 1)
        snprintf(where, sizeof where, "%zu pixels: one in %u, both ways", pixel_grid_count(grid), grid->step);
    snprintf(truth->text, sizeof truth->text, "the reference in %s, at %s", what, where);
    return status;
}

static bool is_off_8bit(const struct transfer_encoder *encoder, const float *value, const double *exact)
{
    const float exact_float[3] = {(float)exact[0], (float)exact[1], (float)exact[2]};
    uint8_t code[3], exact_code[3];
    transfer_encode(encoder, value, 3, code);
    transfer_encode(encoder, exact_float, 3, exact_code);
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
    struct transfer_encoder encoder;
    *error = (struct bench_error){0};
    if (!absolute) {
        log_error("no memory for the errors of %zu pixels", count);
        return STATUS_UNABLE;
    }
    double *relative = absolute + count;
    transfer_encoder_init(TRANSFER_SRGB, &encoder);
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
