#include <stdlib.h>
#include <string.h>
#include <sys/param.h>

#include "base/clock.h"
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

static void copy_row(const struct render_plan *plan, struct reference_window part, int row,
                     const struct reference_picture *picture, struct image *image)
{
    const size_t from = (size_t)row * (size_t)part.width, pixels = (size_t)part.width;
    const size_t to =
        (size_t)(part.y + row - (int)plan->window.y) * image->width + (size_t)(part.x - (int)plan->window.x);
    for (size_t i = 0; i < 3 * pixels; ++i)
        image->rgb[3 * to + i] = (float)picture->rgb[3 * from + i];
    if (image->rgb64)
        memcpy(image->rgb64 + 3 * to, picture->rgb + 3 * from, 3 * pixels * sizeof *picture->rgb);
    for (size_t i = 0; image->truncation && i < pixels; ++i)
        image->truncation[to + i] = (float)truncation_bound(plan->scene, picture->charges[from + i]);
}

/* Parts of a window, from left to right and from top to bottom, that each take about as long: so that
 * progress is seen. */
struct parts {
    struct reference_window part;
    int width, height; /* of the next one */
    int least_height, most_pixels;
};

/* So few pixels that it does not take long, by what is known. */
static struct parts choose_first(const struct render_plan *plan, int threads)
{
    const struct packed_scene *scene = plan->scene;
    const int width = (int)plan->window.width;
    const double of_pixel = scene->samples * (1 + (double)scene->light_samples * scene->quad_light_count);
    const int pixels = of_pixel < 16384 ? (int)(16384 / of_pixel) : 1;
    const int rows = pixels / width / threads * threads;
    return (struct parts){
        .width = rows > 0 ? width : MIN(width, pixels / threads + 1),
        .height = rows > 0 ? rows : threads,
        .least_height = threads,
        .most_pixels = 65536 + threads * width,
    };
}

/* Few parts, as threads wait for each other at the end of each. */
static void choose_next(struct parts *parts, double took_ms, int window_width)
{
    static const double goal_ms = 100;
    const int growth = took_ms < goal_ms / 16 ? 8 : took_ms < goal_ms / 2 ? 2 : 1;
    const int most_rows = parts->most_pixels / window_width / parts->least_height * parts->least_height;
    if (growth > 1 && parts->width < window_width)
        parts->width = MIN(growth * parts->width, window_width);
    else if (growth > 1)
        parts->height = MIN(growth * parts->height, most_rows);
    else if (took_ms > 2 * goal_ms && parts->height >= 2 * parts->least_height)
        parts->height /= 2;
    else if (took_ms > 2 * goal_ms && parts->width > 1)
        parts->width /= 2;
}

/* Goes to the next part; false: there is none. */
static bool step(struct parts *parts, const struct render_plan *plan)
{
    const struct window *window = &plan->window;
    struct reference_window *part = &parts->part;
    const int right = (int)(window->x + window->width), bottom = (int)(window->y + window->height);
    part->x += part->width;
    if (part->x == right || part->height == 0) {
        const int y = part->height == 0 ? (int)window->y : part->y + part->height;
        *part =
            (struct reference_window){.x = (int)window->x, .y = y, .height = MIN(parts->height, bottom - y)};
    }
    part->width = MIN(parts->width, right - part->x);
    return part->height > 0;
}

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
    const int threads = reference_threads(plan->threads), width = (int)plan->window.width;
    struct parts parts = choose_first(plan, threads);
    double *values = calloc((size_t)parts.most_pixels * 4, sizeof *values);
    if (!values) {
        log_error("no memory for %d pixels", parts.most_pixels);
        return STATUS_UNABLE;
    }
    struct reference_picture picture = {
        .rgb = values,
        .charges = plan->bound_truncation ? values + 3 * (size_t)parts.most_pixels : NULL,
    };
    *times = (struct tracer_times){0};
    while (step(&parts, plan)) {
        const uint64_t samples =
            (uint64_t)parts.part.width * (uint64_t)parts.part.height * (uint64_t)plan->scene->samples;
        double start = clock_ms();
        progress_begin(progress, samples);
        render[plan->precision](plan->scene, parts.part, threads, &picture);
        const double took_ms = clock_ms() - start;
        times->dispatch_ms += took_ms;
        for (int row = 0; row < parts.part.height; ++row)
            copy_row(plan, parts.part, row, &picture, image);
        progress_advance(progress, samples);
        choose_next(&parts, took_ms, width);
    }
    rays_add(rays, picture.rays);
    free(values);
    return STATUS_DONE;
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

/* Explains the plan's window in bands, after each of which there is progress. */
static void explain(const struct render_plan *plan, const struct packed_scene *scene,
                    enum precision precision, struct reference_explanation *pixels)
{
    const struct window *window = &plan->window;
    const int threads = reference_threads(plan->threads);
    const unsigned band_height = 4 * (unsigned)threads;
    struct progress progress;
    progress_start(&progress, "exact picture", (uint64_t)window->width * window->height, plan->quiet);
    for (unsigned y = 0; y < window->height; y += band_height) {
        struct reference_window band = band_of(plan, y, band_height);
        struct reference_explanation *first = pixels + (size_t)y * window->width;
        if (precision == PRECISION_DOUBLE)
            reference_explain_double(scene, band, threads, first);
        else
            reference_explain_quad(scene, band, threads, first);
        progress_advance(&progress, (uint64_t)band.width * (uint64_t)band.height);
    }
    progress_end(&progress);
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
    if (*explanations)
        explain(plan, &scene, precision, *explanations);
    return *explanations ? STATUS_DONE : STATUS_UNABLE;
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
