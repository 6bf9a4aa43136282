#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "scene/truncation.h"
#include "tracer/reference_scene.h"
#include "tracer/render.h"

/* At most so many rows of the plan's window, from its row y on. */
static struct reference_window band_of(const struct render_plan *plan, unsigned y, unsigned height)
{
    const struct window *window = &plan->window;
    return (struct reference_window){
        .x = (int)window->x,
        .y = (int)(window->y + y),
        .width = (int)window->width,
        .height = (int)(window->height - y < height ? window->height - y : height),
    };
}

static void copy_band(const struct render_plan *plan, struct reference_window band,
                      const struct reference_picture *picture, struct image *image)
{
    size_t first = (size_t)(band.y - (int)plan->window.y) * image->width;
    size_t pixels = (size_t)band.width * (size_t)band.height;
    for (size_t i = 0; i < 3 * pixels; ++i)
        image->rgb[3 * first + i] = (float)picture->rgb[i];
    if (image->rgb64)
        memcpy(image->rgb64 + 3 * first, picture->rgb, 3 * pixels * sizeof *picture->rgb);
    for (size_t i = 0; image->truncation && i < pixels; ++i)
        image->truncation[first + i] = (float)truncation_bound(plan->scene, picture->charges[i]);
}

/* Renders in bands of some rows, so that Ctrl-C is heard. */
static enum status render_once_on_cpu(void *renderer, const struct render_plan *plan, struct image *image,
                                      struct progress *progress, struct tracer_times *times)
{
    static void (*const render[])(const struct packed_scene *, struct reference_window, int,
                                  struct reference_picture *) = {
        [PRECISION_FLOAT] = reference_render_float,
        [PRECISION_DOUBLE] = reference_render_double,
        [PRECISION_QUAD] = reference_render_quad,
    };
    struct reference_rays *rays = renderer;
    const struct window *window = &plan->window;
    const int threads = reference_threads(plan->threads);
    unsigned band_height = 65536 / window->width + (unsigned)threads;
    size_t band_pixels = (size_t)window->width * band_height;
    double *values = calloc(band_pixels * 4, sizeof *values);
    if (!values) {
        log_error("no memory for %u rows of %u pixels", band_height, window->width);
        return STATUS_UNABLE;
    }
    struct reference_picture picture = {
        .rgb = values,
        .charges = plan->bound_truncation ? values + 3 * band_pixels : NULL,
    };
    *times = (struct tracer_times){0};
    for (unsigned y = 0; y < window->height && !interrupt_requested(); y += band_height) {
        struct reference_window band = band_of(plan, y, band_height);
        double start = clock_ms();
        render[plan->precision](plan->scene, band, threads, &picture);
        times->dispatch_ms += clock_ms() - start;
        copy_band(plan, band, &picture, image);
        progress_advance(progress, (uint64_t)band.width * (uint64_t)band.height);
    }
    rays->primary += picture.rays.primary;
    rays->secondary += picture.rays.secondary;
    rays->shadow += picture.rays.shadow;
    free(values);
    return interrupt_requested() ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum status render_on_cpu(const struct render_plan *plan, struct rendering *rendering)
{
    struct packed_scene scene;
    struct render_plan with_tree = *plan;
    double start = clock_ms();
    *rendering = (struct rendering){0};
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    if (status != STATUS_DONE)
        return status;
    rendering->setup_ms = scene.tree ? clock_ms() - start : 0;
    with_tree.scene = &scene;
    return render_repeatedly(render_once_on_cpu, &rendering->rays, &with_tree, rendering);
}

/* Explains the plan's window in bands, so that Ctrl-C is heard. */
static enum status explain(const struct render_plan *plan, const struct packed_scene *scene,
                           enum precision precision, struct reference_explanation *pixels)
{
    const struct window *window = &plan->window;
    const int threads = reference_threads(plan->threads);
    const unsigned band_height = 4 * (unsigned)threads;
    struct progress progress;
    progress_start(&progress, "exact picture", (uint64_t)window->width * window->height, plan->quiet);
    for (unsigned y = 0; y < window->height && !interrupt_requested(); y += band_height) {
        struct reference_window band = band_of(plan, y, band_height);
        struct reference_explanation *first = pixels + (size_t)y * window->width;
        if (precision == PRECISION_DOUBLE)
            reference_explain_double(scene, band, threads, first);
        else
            reference_explain_quad(scene, band, threads, first);
        progress_advance(&progress, (uint64_t)band.width * (uint64_t)band.height);
    }
    progress_end(&progress);
    return interrupt_requested() ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum status explain_on_cpu(const struct render_plan *plan, enum precision precision,
                           struct reference_explanation **explanations)
{
    struct packed_scene scene;
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    *explanations = NULL;
    if (status != STATUS_DONE)
        return status;
    *explanations = allocate_pixels(&plan->window, sizeof **explanations);
    status = *explanations ? explain(plan, &scene, precision, *explanations) : STATUS_UNABLE;
    if (status == STATUS_DONE)
        return STATUS_DONE;
    free(*explanations);
    *explanations = NULL;
    return status;
}

enum status signatures_on_cpu(const struct render_plan *plan, uint32_t **signatures)
{
    struct packed_scene scene;
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    *signatures = NULL;
    if (status != STATUS_DONE)
        return status;
    struct reference_picture picture = {
        .rgb = allocate_pixels(&plan->window, 3 * sizeof(double)),
        .signatures = allocate_pixels(&plan->window, sizeof **signatures),
    };
    if (picture.rgb && picture.signatures) {
        reference_render_float(&scene, band_of(plan, 0, plan->window.height),
                               reference_threads(plan->threads), &picture);
        *signatures = picture.signatures;
    } else {
        free(picture.signatures);
        status = STATUS_UNABLE;
    }
    free(picture.rgb);
    return status;
}
