#include "bench/pixel_grid.h"

#include <math.h>
#include <stdlib.h>

#include "base/interrupt.h"

enum { PILOT_PIXELS = 300 };

struct pixel_grid pixel_grid_fitting(unsigned width, unsigned height, double most_pixels)
{
    double step = ceil(sqrt((double)width * height / fmax(most_pixels, 1)));
    struct pixel_grid grid = {.step = (unsigned)fmax(1, fmin(step, fmin(width, height)))};
    grid.first = (grid.step - 1) / 2;
    grid.columns = (width - grid.first + grid.step - 1) / grid.step;
    grid.rows = (height - grid.first + grid.step - 1) / grid.step;
    return grid;
}

static struct reference_rays render_pixel(const struct packed_scene *scene, enum grid_output output,
                                          size_t pixel, const struct grid_pixels *pixels)
{
    static void (*const renderers[])(const struct packed_scene *, struct reference_window, int,
                                     struct reference_picture *) = {
        reference_render_float, reference_render_double, reference_render_quad};
    const int place = (int)pixel_grid_place(&pixels->grid, pixel, (unsigned)scene->width);
    const struct reference_window window = {place % scene->width, place / scene->width, 1, 1};
    struct reference_picture picture = {.rgb = &pixels->rgb[3 * pixel],
                                        .signatures = &pixels->signatures[pixel]};
    if (output == GRID_EXPLAINED_QUAD)
        reference_explain_quad(scene, window, 1, &pixels->explanations[pixel]);
    else
        renderers[output](scene, window, 1, &picture);
    return picture.rays;
}

/* Renders the pixels of pixels->grid. */
static enum status render(const struct packed_scene *scene, enum grid_output output,
                          struct progress *progress, double share, struct grid_pixels *pixels)
{
    const size_t count = pixel_grid_count(&pixels->grid);
    const bool explained = output == GRID_EXPLAINED_QUAD;
    double owed = 0;
    pixels->rgb = calloc(count, 3 * sizeof *pixels->rgb);
    pixels->signatures = calloc(count, sizeof *pixels->signatures);
    pixels->explanations = explained ? calloc(count, sizeof *pixels->explanations) : NULL;
    if (!pixels->rgb || !pixels->signatures || (explained && !pixels->explanations)) {
        log_error("no memory for %zu pixels of the reference", count);
        grid_pixels_destroy(pixels);
        return STATUS_UNABLE;
    }
#pragma omp parallel for schedule(dynamic)
    for (size_t i = 0; i < count; ++i) {
        if (interrupt_requested())
            continue;
        struct reference_rays rays = render_pixel(scene, output, i, pixels);
#pragma omp critical
        {
            pixels->rays.primary += rays.primary;
            pixels->rays.secondary += rays.secondary;
            pixels->rays.shadow += rays.shadow;
            owed += share / (double)count;
            if (owed >= 1) {
                progress_advance(progress, (uint64_t)owed);
                owed -= floor(owed);
            }
        }
    }
    if (!interrupt_requested())
        return STATUS_DONE;
    grid_pixels_destroy(pixels);
    return STATUS_INTERRUPTED;
}

enum status grid_render(const struct packed_scene *scene, enum grid_output output, double work,
                        struct progress *progress, double share, struct grid_pixels *pixels)
{
    struct reference_rays rays;
    double pilot_pixels;
    *pixels = (struct grid_pixels){0};
    enum status status = grid_count_rays(scene, &rays, &pilot_pixels);
    if (status != STATUS_DONE)
        return status;
    double lights = scene->quad_light_count > 0 ? scene->light_samples : 1;
    double work_a_pixel = ((double)(rays.primary + rays.secondary) + (double)rays.shadow * lights) *
                          scene->samples * (scene->sphere_count + scene->plane_count + 1) / pilot_pixels;
    pixels->grid = pixel_grid_fitting((unsigned)scene->width, (unsigned)scene->height, work / work_a_pixel);
    return render(scene, output, progress, share, pixels);
}

void grid_pixels_destroy(struct grid_pixels *pixels)
{
    free(pixels->rgb);
    free(pixels->signatures);
    free(pixels->explanations);
    *pixels = (struct grid_pixels){0};
}

enum status grid_count_rays(const struct packed_scene *scene, struct reference_rays *rays, double *pixels)
{
    struct packed_scene pilot = *scene;
    struct grid_pixels result = {
        .grid = pixel_grid_fitting((unsigned)scene->width, (unsigned)scene->height, PILOT_PIXELS)};
    pilot.samples = pilot.light_samples = 1;
    *pixels = (double)pixel_grid_count(&result.grid);
    enum status status = render(&pilot, GRID_FLOAT, NULL, 0, &result);
    *rays = result.rays;
    grid_pixels_destroy(&result);
    return status;
}
