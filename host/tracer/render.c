#include "tracer/render.h"

#include <stdlib.h>

#include "base/statistics.h"

const char *precision_name(enum precision precision)
{
    static const char *const names[] = {"float", "double", "quad"};
    return names[precision];
}

enum status render_repeatedly(render_once *render, void *renderer, const struct render_plan *plan,
                              struct rendering *rendering)
{
    double *warm_ms = calloc(plan->repeat + 1, sizeof *warm_ms);
    enum status status =
        warm_ms ? image_create(plan->window.width, plan->window.height, &rendering->image) : STATUS_UNABLE;
    if (status == STATUS_DONE && plan->precision == PRECISION_DOUBLE)
        status = image_widen(&rendering->image);
    struct progress progress;
    uint64_t pixels = (uint64_t)plan->window.width * plan->window.height;
    progress_start(&progress, "rendering", pixels * (plan->repeat + 1), plan->quiet);
    if (status == STATUS_DONE)
        status = render(renderer, plan, &rendering->image, &progress, &rendering->first_dispatch_ms);
    for (unsigned i = 0; i < plan->repeat && status == STATUS_DONE; ++i)
        status = render(renderer, plan, &rendering->image, &progress, &warm_ms[i]);
    progress_end(&progress);
    if (status == STATUS_DONE) {
        sort_doubles(warm_ms, plan->repeat);
        rendering->dispatch_ms =
            plan->repeat ? sorted_quantile(warm_ms, plan->repeat, 0.5) : rendering->first_dispatch_ms;
    } else {
        image_destroy(&rendering->image);
    }
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
