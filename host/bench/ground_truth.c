#include "bench/ground_truth.h"

#include <stdio.h>
#include <stdlib.h>

enum { ALL_BOUNCES = 64, STRIDE_OF_BOUNCES = 4, PILOT_PIXELS = 300 };

static const double most_rays_a_pixel = 2000;

/* Room for the colours of so many pixels; NULL (reported) without memory. */
static double *allocate_rgb(size_t pixels)
{
    double *rgb = calloc(pixels, 3 * sizeof *rgb);
    if (!rgb)
        log_error("no memory for %zu pixels", pixels);
    return rgb;
}

/* Counts the rays of some of the picture's pixels, with one sample of everything. */
static enum status count_rays(const struct packed_scene *packed, struct reference_rays *rays, double *pixels)
{
    struct packed_scene pilot = *packed;
    pilot.samples = pilot.light_samples = 1;
    struct pixel_grid grid = pixel_grid_fitting((unsigned)pilot.width, (unsigned)pilot.height, PILOT_PIXELS);
    struct grid_pixels result = {.rgb = allocate_rgb(pixel_grid_count(&grid))};
    *rays = (struct reference_rays){0};
    *pixels = (double)pixel_grid_count(&grid);
    if (!result.rgb)
        return STATUS_UNABLE;
    enum status status = pixel_grid_render(&pilot, PRECISION_FLOAT, &grid, &result, NULL, 0);
    free(result.rgb);
    *rays = result.rays;
    return status;
}

enum status grid_of_work(const struct packed_scene *packed, double work, struct pixel_grid *grid)
{
    struct reference_rays rays;
    double pixels;
    enum status status = count_rays(packed, &rays, &pixels);
    if (status != STATUS_DONE)
        return status;
    double lights = packed->quad_light_count > 0 ? packed->light_samples : 1;
    double work_a_pixel = ((double)(rays.primary + rays.secondary) + (double)rays.shadow * lights) *
                          packed->samples * (packed->sphere_count + packed->plane_count + 1) / pixels;
    *grid = pixel_grid_fitting((unsigned)packed->width, (unsigned)packed->height, work / work_a_pixel);
    return STATUS_DONE;
}

enum status ground_truth_bounces(const struct packed_scene *packed, unsigned *most)
{
    struct packed_scene pilot = *packed;
    *most = (unsigned)packed->max_bounces;
    while (*most < ALL_BOUNCES) {
        struct reference_rays rays;
        double pixels;
        unsigned next = *most + STRIDE_OF_BOUNCES;
        pilot.max_bounces = (int)(next < ALL_BOUNCES ? next : ALL_BOUNCES);
        enum status status = count_rays(&pilot, &rays, &pixels);
        if (status != STATUS_DONE || (double)rays.secondary > most_rays_a_pixel * pixels)
            return status;
        *most = (unsigned)pilot.max_bounces;
    }
    return STATUS_DONE;
}

/* The text `what` says what it is; where it holds is added. */
static enum status create(const struct scene *scene, struct picture_settings *settings,
                          enum precision precision, double work, const char *what, struct progress *progress,
                          double share, struct ground_truth *truth)
{
    struct packed_scene packed;
    *truth = (struct ground_truth){0};
    enum status status = pack_scene(scene, settings, &packed);
    if (status != STATUS_DONE)
        return status;
    status = grid_of_work(&packed, work, &truth->grid);
    if (status == STATUS_DONE) {
        struct grid_pixels pixels = {.rgb = truth->rgb = allocate_rgb(pixel_grid_count(&truth->grid))};
        status = truth->rgb ? pixel_grid_render(&packed, precision, &truth->grid, &pixels, progress, share)
                            : STATUS_UNABLE;
    }
    pack_destroy(&packed);
    if (status != STATUS_DONE) {
        ground_truth_destroy(truth);
        return status;
    }
    int length = snprintf(truth->text, sizeof truth->text, "the reference in %s, at ", what);
    if (truth->grid.step == 1)
        snprintf(truth->text + length, sizeof truth->text - (size_t)length, "every pixel");
    else
        snprintf(truth->text + length, sizeof truth->text - (size_t)length,
                 "%zu pixels: one in %u, both ways", pixel_grid_count(&truth->grid), truth->grid.step);
    return STATUS_DONE;
}

enum status ground_truth_create(const struct scene *scene, struct picture_settings settings, bool sampled,
                                const struct truth_effort *effort, struct progress *progress, double share,
                                struct ground_truth *truth)
{
    char what[100];
    if (sampled) {
        settings.light_samples = effort->samples;
        snprintf(what, sizeof what, "double with %u bounces and %u light samples", settings.max_bounces,
                 settings.light_samples);
    } else {
        snprintf(what, sizeof what, "quad (binary128) with %u bounces", settings.max_bounces);
    }
    return create(scene, &settings, sampled ? PRECISION_DOUBLE : PRECISION_QUAD,
                  sampled ? effort->with_double : effort->quad, what, progress, share, truth);
}

enum status ground_truth_create_filtered(const struct scene *scene, struct picture_settings settings,
                                         const struct truth_effort *effort, struct progress *progress,
                                         double share, struct ground_truth *truth)
{
    char what[100];
    settings.samples = effort->samples;
    settings.light_samples = 1; /* of each pixel sample: together as many as those */
    snprintf(what, sizeof what, "double with %u samples a pixel", settings.samples);
    return create(scene, &settings, PRECISION_DOUBLE, effort->with_double, what, progress, share, truth);
}

void ground_truth_destroy(struct ground_truth *truth)
{
    free(truth->rgb);
    *truth = (struct ground_truth){0};
}
