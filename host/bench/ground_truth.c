#include "bench/ground_truth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ALL_BOUNCES = 64, STRIDE_OF_BOUNCES = 4, PILOT_PIXELS = 300 };

static const double most_rays_a_pixel = 2000;

/* Rays a pixel, from some of the pixels. */
static enum status count_rays(const struct packed_scene *packed, struct reference_rays *rays, size_t *pixels)
{
    struct pixel_grid grid =
        pixel_grid_fitting((unsigned)packed->width, (unsigned)packed->height, PILOT_PIXELS);
    *pixels = pixel_grid_count(&grid);
    struct grid_pixels result = {.rgb = calloc(*pixels, 3 * sizeof(double))};
    if (!result.rgb) {
        log_error("no memory for %zu pixels", *pixels);
        return STATUS_UNABLE;
    }
    enum status status = pixel_grid_render(packed, PRECISION_FLOAT, &grid, &result, NULL, 0);
    free(result.rgb);
    *rays = result.rays;
    return status;
}

/* Work of a pixel of the picture: rays times objects. */
static enum status pixel_work(const struct packed_scene *packed, double *work)
{
    struct packed_scene pilot = *packed;
    struct reference_rays rays;
    size_t pixels;
    pilot.samples = pilot.light_samples = 1;
    enum status status = count_rays(&pilot, &rays, &pixels);
    double lights = packed->quad_light_count > 0 ? packed->light_samples : 1;
    *work = ((double)(rays.primary + rays.secondary) + (double)rays.shadow * lights) * packed->samples *
            (packed->sphere_count + packed->plane_count + 1) / (double)pixels;
    return status;
}

enum status bench_deepest(const struct scene *scene, const struct picture_settings *settings,
                          unsigned *deepest, bool *has_secondary_rays)
{
    struct packed_scene packed;
    struct picture_settings pilot = *settings;
    pilot.samples = pilot.light_samples = 1;
    *deepest = settings->max_bounces;
    *has_secondary_rays = false;
    for (size_t i = 0; i < scene->object_count; ++i)
        if (scene->materials[scene->objects[i].material].type != MATERIAL_MATTE)
            *has_secondary_rays = true;
    enum status status = pack_scene(scene, &pilot, &packed);
    if (status != STATUS_DONE)
        return status;
    while (*has_secondary_rays && *deepest < ALL_BOUNCES && status == STATUS_DONE) {
        unsigned next =
            *deepest + STRIDE_OF_BOUNCES < ALL_BOUNCES ? *deepest + STRIDE_OF_BOUNCES : ALL_BOUNCES;
        struct reference_rays rays;
        size_t pixels;
        packed.max_bounces = (int)next;
        status = count_rays(&packed, &rays, &pixels);
        if ((double)rays.secondary > most_rays_a_pixel * (double)pixels)
            break;
        *deepest = next;
    }
    pack_destroy(&packed);
    return status;
}

static enum status compute(const struct scene *scene, const struct picture_settings *settings, double work,
                           struct progress *progress, double progress_total, struct ground_truth *truth)
{
    struct packed_scene packed;
    double work_per_pixel;
    enum status status = pack_scene(scene, settings, &packed);
    if (status != STATUS_DONE)
        return status;
    status = pixel_work(&packed, &work_per_pixel);
    if (status == STATUS_DONE) {
        truth->grid = pixel_grid_fitting(settings->width, settings->height, work / work_per_pixel);
        truth->rgb = calloc(pixel_grid_count(&truth->grid), 3 * sizeof *truth->rgb);
        if (truth->rgb) {
            struct grid_pixels pixels = {.rgb = truth->rgb};
            status =
                pixel_grid_render(&packed, truth->precision, &truth->grid, &pixels, progress, progress_total);
        } else {
            log_error("no memory for %zu pixels", pixel_grid_count(&truth->grid));
            status = STATUS_UNABLE;
        }
    }
    pack_destroy(&packed);
    if (status != STATUS_DONE)
        ground_truth_destroy(truth);
    return status;
}

/* Completes the text with where it holds. */
static void say_where(struct ground_truth *truth)
{
    size_t length = strlen(truth->text);
    char *end = truth->text + length;
    if (truth->grid.step == 1)
        snprintf(end, sizeof truth->text - length, ", at every pixel");
    else
        snprintf(end, sizeof truth->text - length, ", at %zu pixels: one in %u, both ways",
                 pixel_grid_count(&truth->grid), truth->grid.step);
}

enum status ground_truth_create(const struct scene *scene, struct picture_settings settings, unsigned deepest,
                                const struct bench_effort *effort, struct progress *progress,
                                double progress_total, struct ground_truth *truth)
{
    bool sampled = false;
    for (size_t i = 0; i < scene->light_count; ++i)
        sampled = sampled || scene->lights[i].type == LIGHT_QUAD;
    *truth = (struct ground_truth){.precision = sampled ? PRECISION_DOUBLE : PRECISION_QUAD};
    settings.max_bounces = deepest;
    if (sampled)
        settings.light_samples = effort->samples;
    enum status status = compute(scene, &settings, sampled ? effort->double_work : effort->quad_work,
                                 progress, progress_total, truth);
    int length = snprintf(truth->text, sizeof truth->text, "the reference in %s with %u bounces",
                          sampled ? "double" : "quad (binary128)", deepest);
    if (sampled)
        snprintf(truth->text + length, sizeof truth->text - (size_t)length, " and %u light samples",
                 settings.light_samples);
    say_where(truth);
    return status;
}

enum status ground_truth_create_filtered(const struct scene *scene, struct picture_settings settings,
                                         const struct bench_effort *effort, struct progress *progress,
                                         double progress_total, struct ground_truth *truth)
{
    *truth = (struct ground_truth){.precision = PRECISION_DOUBLE};
    settings.samples = effort->samples;
    settings.light_samples = 1; /* of each pixel sample: together as many as those */
    enum status status = compute(scene, &settings, effort->double_work, progress, progress_total, truth);
    snprintf(truth->text, sizeof truth->text, "the reference in double with %u samples a pixel",
             settings.samples);
    say_where(truth);
    return status;
}

void ground_truth_destroy(struct ground_truth *truth)
{
    free(truth->rgb);
    *truth = (struct ground_truth){0};
}

double bench_explained_pixels(const struct packed_scene *packed, double work)
{
    double work_per_pixel;
    return pixel_work(packed, &work_per_pixel) == STATUS_DONE ? work / work_per_pixel : 1;
}
