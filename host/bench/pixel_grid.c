#include "bench/pixel_grid.h"

#include <math.h>
#include <unistd.h>

#include "base/interrupt.h"

struct pixel_grid pixel_grid_fitting(unsigned width, unsigned height, double most_pixels)
{
    double step = ceil(sqrt((double)width * height / fmax(most_pixels, 1)));
    unsigned least = width < height ? width : height;
    struct pixel_grid grid = {.step = step < least ? (unsigned)step : least};
    grid.step = grid.step < 1 ? 1 : grid.step;
    grid.first_x = grid.first_y = (grid.step - 1) / 2;
    grid.columns = (width - grid.first_x + grid.step - 1) / grid.step;
    grid.rows = (height - grid.first_y + grid.step - 1) / grid.step;
    return grid;
}

static struct reference_rays render_pixel(const struct packed_scene *scene, enum precision precision, int x,
                                          int y, size_t pixel, struct grid_pixels *pixels)
{
    const struct reference_window window = {x, y, 1, 1};
    struct reference_picture picture = {
        .rgb = pixels->rgb ? &pixels->rgb[3 * pixel] : NULL,
        .signatures = pixels->signatures ? &pixels->signatures[pixel] : NULL,
    };
    if (pixels->explanations && precision == PRECISION_QUAD)
        reference_explain_quad(scene, window, 1, &pixels->explanations[pixel]);
    else if (pixels->explanations)
        reference_explain_double(scene, window, 1, &pixels->explanations[pixel]);
    else if (precision == PRECISION_QUAD)
        reference_render_quad(scene, window, 1, &picture);
    else if (precision == PRECISION_DOUBLE)
        reference_render_double(scene, window, 1, &picture);
    else
        reference_render_float(scene, window, 1, &picture);
    return picture.rays;
}

enum status pixel_grid_render(const struct packed_scene *scene, enum precision precision,
                              const struct pixel_grid *grid, struct grid_pixels *pixels,
                              struct progress *progress, double progress_total)
{
    const int processors = (int)sysconf(_SC_NPROCESSORS_ONLN), columns = (int)grid->columns;
    const int most_rows = 1 + 64 / columns;
    double owed = 0;
    for (int row = 0; row < (int)grid->rows; row += most_rows) {
        int rows = (int)grid->rows - row < most_rows ? (int)grid->rows - row : most_rows;
        uint64_t primary = 0, secondary = 0, shadow = 0;
#pragma omp parallel for schedule(dynamic) num_threads(processors) reduction(+ : primary, secondary, shadow)
        for (int i = row * columns; i < (row + rows) * columns; ++i) {
            if (interrupt_requested())
                continue;
            struct reference_rays rays =
                render_pixel(scene, precision, (int)(grid->first_x + (unsigned)(i % columns) * grid->step),
                             (int)(grid->first_y + (unsigned)(i / columns) * grid->step), (size_t)i, pixels);
            primary += rays.primary;
            secondary += rays.secondary;
            shadow += rays.shadow;
        }
        pixels->rays.primary += primary;
        pixels->rays.secondary += secondary;
        pixels->rays.shadow += shadow;
        if (interrupt_requested())
            return STATUS_INTERRUPTED;
        owed += progress_total * rows / (double)grid->rows;
        if (progress)
            progress_advance(progress, (uint64_t)owed);
        owed -= floor(owed);
    }
    return STATUS_DONE;
}
