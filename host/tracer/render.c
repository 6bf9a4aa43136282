#include "tracer/render.h"

#include <stdlib.h>

#include "base/statistics.h"

const char *precision_name(enum precision precision)
{
    static const char *const names[] = {"float", "double", "quad"};
    return names[precision];
}

/* Renders the plan's strips one after the other. */
static enum status render_strips(render_once *render, void *renderer, const struct render_plan *plan,
                                 const struct image *image, struct progress *progress,
                                 struct tracer_times *times)
{
    enum status status = STATUS_DONE;
    *times = (struct tracer_times){0};
    for (unsigned y = 0; y < plan->window.height && status == STATUS_DONE;) {
        const size_t first = (size_t)y * image->width;
        struct tracer_times of_strip;
        struct render_plan strip = *plan;
        strip.window = window_strip(plan->window, plan->strips, y);
        struct image part = {
            .width = image->width,
            .height = strip.window.height,
            .rgb = image->rgb + 3 * first,
            .rgb64 = image->rgb64 ? image->rgb64 + 3 * first : NULL,
            .truncation = image->truncation ? image->truncation + first : NULL,
        };
        status = render(renderer, &strip, &part, progress, &of_strip);
        times->dispatch_ms += of_strip.dispatch_ms;
        times->device_ms += of_strip.device_ms;
        y += strip.window.height;
    }
    return status;
}

enum status render_repeatedly(render_once *render, void *renderer, const struct render_plan *plan,
                              struct rendering *rendering)
{
    struct image *image = &rendering->image;
    double *warm_ms = calloc(2 * (size_t)plan->repeat + 2, sizeof *warm_ms),
           *device_ms = warm_ms + plan->repeat;
    if (!warm_ms)
        log_error("no memory for the times of %u renderings", plan->repeat);
    enum status status =
        warm_ms ? image_create(plan->window.width, plan->window.height, image) : STATUS_UNABLE;
    if (status == STATUS_DONE && plan->precision == PRECISION_DOUBLE)
        status = image_widen(image);
    if (status == STATUS_DONE && plan->bound_truncation) {
        image->truncation = allocate_pixels(&plan->window, sizeof *image->truncation);
        status = image->truncation ? STATUS_DONE : STATUS_UNABLE;
    }
    struct progress progress;
    uint64_t samples = (uint64_t)plan->window.width * plan->window.height * (uint64_t)plan->scene->samples;
    progress_start(&progress, "rendering", samples * (plan->repeat + 1), plan->quiet);
    if (status == STATUS_DONE)
        status = render_strips(render, renderer, plan, image, &progress, &rendering->times);
    rendering->first_dispatch_ms = rendering->times.dispatch_ms;
    for (unsigned i = 0; i < plan->repeat && status == STATUS_DONE; ++i) {
        rendering->rays = (struct reference_rays){0};
        status = render_strips(render, renderer, plan, image, &progress, &rendering->times);
        warm_ms[i] = rendering->times.dispatch_ms;
        device_ms[i] = rendering->times.device_ms;
    }
    progress_end(&progress);
    if (status == STATUS_DONE && plan->repeat > 0) {
        sort_doubles(warm_ms, plan->repeat);
        sort_doubles(device_ms, plan->repeat);
        rendering->times.dispatch_ms = sorted_quantile(warm_ms, plan->repeat, 0.5);
        rendering->times.device_ms = sorted_quantile(device_ms, plan->repeat, 0.5);
    }
    if (status != STATUS_DONE)
        image_destroy(image);
    free(warm_ms);
    return status;
}

void *allocate_pixels(const struct window *window, size_t size)
{
    void *pixels = calloc((size_t)window->width * window->height, size);
    if (!pixels)
        log_error("no memory for %u x %u pixels of %zu bytes", window->width, window->height, size);
    return pixels;
}
