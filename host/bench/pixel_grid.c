#include "bench/pixel_grid.h"

#include <math.h>
#include <unistd.h>

#include "base/interrupt.h"

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
                                          size_t place, size_t pixel, const struct grid_pixels *pixels)
{
    static void (*const renderers[])(const struct packed_scene *, struct reference_window, int,
                                     struct reference_picture *) = {
        reference_render_float, reference_render_double, reference_render_quad};
    const size_t width = (size_t)scene->width;
    const struct reference_window window = {(int)(place % width), (int)(place / width), 1, 1};
    struct reference_picture picture = {
        .rgb = &pixels->rgb[3 * pixel],
        .signatures = pixels->signatures ? &pixels->signatures[pixel] : NULL,
    };
    if (pixels->explanations)
        reference_explain_quad(scene, window, 1, &pixels->explanations[pixel]);
    else
        renderers[precision](scene, window, 1, &picture);
    return picture.rays;
}

enum status pixel_grid_render(const struct packed_scene *scene, enum precision precision,
                              const struct pixel_grid *grid, struct grid_pixels *pixels,
                              struct progress *progress, double share)
{
    const int processors = (int)sysconf(_SC_NPROCESSORS_ONLN);
    const size_t count = pixel_grid_count(grid);
    double owed = 0;
#pragma omp parallel for schedule(dynamic) num_threads(processors)
    for (size_t i = 0; i < count; ++i) {
        if (interrupt_requested())
            continue;
        size_t place = pixel_grid_place(grid, i, (unsigned)scene->width);
        struct reference_rays rays = render_pixel(scene, precision, place, i, pixels);
#pragma omp critical
        {
            pixels->rays.primary += rays.primary;
            pixels->rays.secondary += rays.secondary;
            pixels->rays.shadow += rays.shadow;
            owed += share / (double)count;
            if (progress && owed >= 1) {
                progress_advance(progress, (uint64_t)owed);
                owed -= floor(owed);
            }
        }
    }
    return interrupt_requested() ? STATUS_INTERRUPTED : STATUS_DONE;
}
