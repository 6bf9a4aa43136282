#include <stdlib.h>

#include "base/clock.h"
#include "scene/truncation.h"
#include "tracer/render.h"

static enum status render_once_on_device(void *renderer, const struct render_plan *plan, struct image *image,
                                         struct progress *progress, double *milliseconds)
{
    return tracer_render(renderer, plan->window, image, progress, milliseconds);
}

/* Renders another output than radiance. */
static enum status render_output(struct vulkan_context *context, const struct render_plan *plan, int output,
                                 const struct tracer_values *values)
{
    static const char *const tasks[] = {
        [OUTPUT_RAYS] = "counting rays",
        [OUTPUT_SIGNATURE] = "path signatures",
        [OUTPUT_TRUNCATION] = "untraced rays",
    };
    struct tracer *tracer;
    struct progress progress;
    double unused_ms;
    progress_start(&progress, tasks[output], (uint64_t)plan->window.width * plan->window.height, plan->quiet);
    enum status status = tracer_create(context, plan->scene,
                                       &(struct tracer_options){
                                           .double_precision = plan->precision == PRECISION_DOUBLE,
                                           .fast = plan->fast,
                                           .output = output,
                                       },
                                       &tracer);
    if (status == STATUS_DONE)
        status = tracer_render_values(tracer, plan->window, values, &progress, &unused_ms);
    progress_end(&progress);
    tracer_destroy(&tracer);
    return status;
}

enum status rays_on_device(struct vulkan_context *context, const struct render_plan *plan,
                           struct reference_rays *rays)
{
    struct reference_rays traced;
    enum status status = render_output(context, plan, OUTPUT_RAYS, &(struct tracer_values){.rays = &traced});
    if (status != STATUS_DONE)
        return status;
    rays->primary += traced.primary;
    rays->secondary += traced.secondary;
    rays->shadow += traced.shadow;
    return STATUS_DONE;
}

enum status signatures_on_device(struct vulkan_context *context, const struct render_plan *plan,
                                 uint32_t **signatures)
{
    *signatures = allocate_pixels(&plan->window, sizeof **signatures);
    if (!*signatures)
        return STATUS_UNABLE;
    enum status status =
        render_output(context, plan, OUTPUT_SIGNATURE, &(struct tracer_values){.signatures = *signatures});
    if (status != STATUS_DONE) {
        free(*signatures);
        *signatures = NULL;
    }
    return status;
}

static enum status bound_truncation(struct vulkan_context *context, const struct render_plan *plan,
                                    struct image *image)
{
    struct image charges;
    image->truncation = allocate_pixels(&plan->window, sizeof *image->truncation);
    enum status status =
        image->truncation ? image_create(image->width, image->height, &charges) : STATUS_UNABLE;
    if (status != STATUS_DONE)
        return status;
    status = render_output(context, plan, OUTPUT_TRUNCATION, &(struct tracer_values){.image = &charges});
    for (size_t i = 0; status == STATUS_DONE && i < (size_t)charges.width * charges.height; ++i)
        image->truncation[i] = (float)truncation_bound(plan->scene, (double)charges.rgb[3 * i]);
    image_destroy(&charges);
    return status;
}

enum status render_on_device(struct vulkan_context *context, const struct render_plan *plan,
                             struct rendering *rendering)
{
    *rendering = (struct rendering){0};
    double start = clock_ms();
    struct tracer *tracer;
    enum status status = tracer_create(context, plan->scene,
                                       &(struct tracer_options){
                                           .double_precision = plan->precision == PRECISION_DOUBLE,
                                           .fast = plan->fast,
                                       },
                                       &tracer);
    if (status != STATUS_DONE)
        return status;
    rendering->setup_ms = clock_ms() - start;
    status = render_repeatedly(render_once_on_device, tracer, plan, rendering);
    tracer_destroy(&tracer);
    if (status != STATUS_DONE)
        return status;
    if (plan->count_rays)
        status = rays_on_device(context, plan, &rendering->rays);
    if (status == STATUS_DONE && plan->bound_truncation)
        status = bound_truncation(context, plan, &rendering->image);
    if (status != STATUS_DONE)
        image_destroy(&rendering->image);
    return status;
}
