#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "scene/truncation.h"
#include "tracer/reference_scene.h"
#include "tracer/render.h"

enum {
    PIXELS_AT_ONCE = 16,    /* that a thread takes */
    RAYS_BETWEEN = 1 << 17, /* that a thread traces before it tells; some 50 ms */
};

static void put_pixel(const struct packed_scene *scene, const struct reference_pixel *pixel, size_t place,
                      const struct tracer_values *values)
{
    struct image *image = values->image;
    if (values->signatures)
        values->signatures[place] = pixel->signature;
    for (size_t c = 0; image && c < 3; ++c)
        image->rgb[3 * place + c] = (float)pixel->rgb[c];
    if (image && image->rgb64)
        memcpy(image->rgb64 + 3 * place, pixel->rgb, sizeof pixel->rgb);
    if (image && image->truncation)
        image->truncation[place] = (float)truncation_bound(scene, pixel->charges);
}

/* Adds what a thread has traced since it last told. */
static void tell(struct reference_rays *traced, struct reference_rays *sum, struct progress *progress)
{
#pragma omp critical(reference_progress)
    {
        rays_add(sum, *traced);
        progress_advance(progress, traced->primary);
    }
    *traced = (struct reference_rays){0};
}

/* Traces the plan's window in its precision; values.rays are not set, but added to. */
static void trace_window(const struct render_plan *plan, const struct packed_scene *scene,
                         const struct tracer_values *values, struct progress *progress)
{
    static reference_tracer *const tracers[] = {
        [PRECISION_FLOAT] = reference_trace_float,
        [PRECISION_DOUBLE] = reference_trace_double,
        [PRECISION_QUAD] = reference_trace_quad,
    };
    const struct window window = plan->window;
    const size_t pixels = (size_t)window.width * window.height;
#pragma omp parallel num_threads(reference_threads(plan->threads))
    {
        struct reference_rays traced = {0};
#pragma omp for schedule(dynamic, PIXELS_AT_ONCE)
        for (size_t i = 0; i < pixels; ++i) {
            const int x = (int)(window.x + i % window.width), y = (int)(window.y + i / window.width);
            const struct reference_pixel pixel = tracers[plan->precision](scene, x, y, NULL);
            put_pixel(scene, &pixel, i, values);
            rays_add(&traced, pixel.rays);
            if (traced.primary + traced.secondary + traced.shadow > RAYS_BETWEEN)
                tell(&traced, values->rays, progress);
        }
        tell(&traced, values->rays, progress);
    }
}

static enum status render_once_on_cpu(void *renderer, const struct render_plan *plan, struct image *image,
                                      struct progress *progress, struct tracer_times *times)
{
    const double start = clock_ms();
    trace_window(plan, plan->scene, &(struct tracer_values){.image = image, .rays = renderer}, progress);
    *times = (struct tracer_times){.dispatch_ms = clock_ms() - start};
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

enum status explain_on_cpu(const struct render_plan *plan, enum precision precision,
                           struct reference_explanation **explanations)
{
    reference_explainer *const explain =
        precision == PRECISION_DOUBLE ? reference_explain_double : reference_explain_quad;
    const struct window window = plan->window;
    const size_t pixels = (size_t)window.width * window.height;
    struct packed_scene scene;
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    *explanations = NULL;
    if (status != STATUS_DONE)
        return status;
    *explanations = allocate_pixels(&window, sizeof **explanations);
    if (!*explanations)
        return STATUS_UNABLE;
    struct progress progress;
    progress_start(&progress, "exact picture", pixels, plan->quiet);
#pragma omp parallel for schedule(dynamic) num_threads(reference_threads(plan->threads))
    for (size_t i = 0; i < pixels; ++i) {
        const int x = (int)(window.x + i % window.width), y = (int)(window.y + i / window.width);
        (*explanations)[i] = explain(&scene, x, y, NULL);
#pragma omp critical(reference_progress)
        progress_advance(&progress, 1);
    }
    progress_end(&progress);
    return STATUS_DONE;
}

enum status signatures_on_cpu(const struct render_plan *plan, uint32_t **signatures)
{
    struct packed_scene scene;
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    *signatures = NULL;
    if (status != STATUS_DONE)
        return status;
    *signatures = allocate_pixels(&plan->window, sizeof **signatures);
    if (!*signatures)
        return STATUS_UNABLE;
    struct render_plan in_float = *plan;
    in_float.precision = PRECISION_FLOAT;
    struct progress progress;
    progress_start(&progress, "path signatures",
                   (uint64_t)plan->window.width * plan->window.height * (uint64_t)scene.samples, plan->quiet);
    trace_window(&in_float, &scene,
                 &(struct tracer_values){.signatures = *signatures, .rays = &(struct reference_rays){0}},
                 &progress);
    progress_end(&progress);
    return STATUS_DONE;
}
