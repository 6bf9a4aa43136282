#include <stdlib.h>

#include "base/clock.h"
#include "scene/truncation.h"
#include "tracer/render.h"

enum status render_once_on_device(void *renderer, const struct render_plan *plan, struct image *image,
                                  struct progress *progress, struct tracer_times *times)
{
    return tracer_render(renderer, plan->window, &(struct tracer_values){.image = image}, progress, times);
}

static enum status create_tracer(struct vulkan_context *context, const struct render_plan *plan, bool counts,
                                 struct tracer **tracer)
{
    const struct tracer_options options = {
        .double_precision = plan->precision == PRECISION_DOUBLE,
        .fast = plan->fast,
        .shaders = plan->shaders,
        .counts = counts,
        .charges = !counts && plan->bound_truncation,
    };
    return tracer_create(context, plan->scene, &options, tracer);
}

/* Counts rays and notes signatures, in a pipeline of its own. */
static enum status render_counts(struct vulkan_context *context, const struct render_plan *plan,
                                 const char *task, const struct tracer_values *values)
{
    struct tracer *tracer;
    struct progress progress;
    struct tracer_times unused;
    progress_start(&progress, task,
                   (uint64_t)plan->window.width * plan->window.height * (uint64_t)plan->scene->samples,
                   plan->quiet);
    enum status status = create_tracer(context, plan, true, &tracer);
    for (unsigned y = 0; y < plan->window.height && status == STATUS_DONE;) {
        const struct window strip = window_strip(plan->window, plan->strips, y);
        status = tracer_render(tracer, strip, values, &progress, &unused);
        y += strip.height;
    }
    progress_end(&progress);
    tracer_destroy(&tracer);
    return status;
}

enum status rays_on_device(struct vulkan_context *context, const struct render_plan *plan,
                           struct reference_rays *rays)
{
    return render_counts(context, plan, "counting rays", &(struct tracer_values){.rays = rays});
}

enum status signatures_on_device(struct vulkan_context *context, const struct render_plan *plan,
                                 uint32_t **signatures)
{
    *signatures = allocate_pixels(&plan->window, sizeof **signatures);
    if (!*signatures)
        return STATUS_UNABLE;
    enum status status =
        render_counts(context, plan, "path signatures", &(struct tracer_values){.signatures = *signatures});
    if (status != STATUS_DONE) {
        free(*signatures);
        *signatures = NULL;
    }
    return status;
}

enum status render_on_device(struct vulkan_context *context, const struct render_plan *plan,
                             struct rendering *rendering)
{
    *rendering = (struct rendering){0};
    double start = clock_ms();
    struct tracer *tracer;
    enum status status = create_tracer(context, plan, false, &tracer);
    if (status != STATUS_DONE)
        return status;
    rendering->setup_ms = clock_ms() - start;
    status = render_repeatedly(render_once_on_device, tracer, plan, rendering);
    tracer_destroy(&tracer);
    if (status != STATUS_DONE)
        return status;
    struct image *image = &rendering->image;
    for (size_t i = 0; image->truncation && i < (size_t)image->width * image->height; ++i)
        image->truncation[i] = (float)truncation_bound(plan->scene, (double)image->truncation[i]);
    if (plan->count_rays)
        status = rays_on_device(context, plan, &rendering->rays);
    if (status != STATUS_DONE)
        image_destroy(&rendering->image);
    return status;
}
