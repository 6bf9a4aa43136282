#include "cli/options.h"

#include <stdio.h>

#include "base/clock.h"
#include "base/json.h"
#include "check/float_limit.h"
#include "check/spot_check.h"
#include "tracer/job.h"

/* Rays that max_bounces cuts off count against --max-error, and may be too much for it. */
static void report_truncation(const struct options *options, const struct job *job, const struct image *image)
{
    size_t pixels = (size_t)image->width * image->height, beyond = 0;
    float largest = 0;
    for (size_t i = 0; i < pixels; ++i) {
        beyond += (double)image->truncation[i] > options->job.max_error;
        largest = image->truncation[i] > largest ? image->truncation[i] : largest;
    }
    if (beyond > 0)
        log_warning(
            "%s: %zu of %zu pixels may be off by more than --max-error %g, by up to %g: rays end after "
            "%d bounces; see --max-bounces",
            options->scenes[0], beyond, pixels, options->job.max_error, (double)largest,
            job->packed.max_bounces);
}

static enum status write_stats(const struct options *options, const struct job *job,
                               const struct rendering *rendering, const struct vulkan_context *context,
                               const char *device, double write_ms)
{
    const struct reference_rays *rays = &rendering->rays;
    double total = (double)(rays->primary + rays->secondary + rays->shadow);
    json_t *driver = context ? json_sprintf("%s %s", context->driver.driverName, context->driver.driverInfo)
                             : json_string("plain-C reference");
    json_t *stats = json_pack(
        "{s:s, s:s, s:o, s:i, s:i, s:s, s:s, s:i, s:i, s:i, s:f, s:f, s:f, s:f, s:f, s:{s:I, s:I, s:I}, s:f}",
        "scene", options->scenes[0], "device", device, "driver", driver, "width", (int)job->plan.window.width,
        "height", (int)job->plan.window.height, "precision", precision_name(options->job.plan.precision),
        "mode", options->job.plan.fast ? "fast" : "exact", "max_bounces", job->packed.max_bounces, "samples",
        job->packed.samples, "light_samples", job->packed.light_samples, "setup_ms", rendering->setup_ms,
        "first_dispatch_ms", rendering->first_dispatch_ms, "dispatch_ms", rendering->times.dispatch_ms,
        "device_ms", rendering->times.device_ms, "write_ms", write_ms, "rays", "primary",
        (json_int_t)rays->primary, "secondary", (json_int_t)rays->secondary, "shadow",
        (json_int_t)rays->shadow, "rays_per_second",
        rendering->times.dispatch_ms > 0 ? total / rendering->times.dispatch_ms * 1000 : 0);
    return json_write(stats, options->stats);
}

static enum status deliver(const struct options *options, const struct job *job,
                           const struct rendering *rendering, const struct vulkan_context *context)
{
    const char *device = context ? context->properties.deviceName : "cpu";
    if (options->job.has_max_error)
        report_truncation(options, job, &rendering->image);
    double start = clock_ms();
    enum status status =
        job_write(job, &rendering->image, options->outputs, options->output_count, options->transfer, device);
    double write_ms = clock_ms() - start;
    if (options->stats)
        status = status_worse(status, write_stats(options, job, rendering, context, device, write_ms));
    if (status == STATUS_DONE)
        log_notice("%s: %ux%u in %.1f ms on %s (set-up %.1f ms, writing %.1f ms)", options->scenes[0],
                   rendering->image.width, rendering->image.height, rendering->times.dispatch_ms, device,
                   rendering->setup_ms, write_ms);
    return status;
}

enum status command_render(const struct options *options)
{
    struct vulkan_context *context = NULL; /* stays so with --backend cpu */
    struct rendering rendering;
    struct job job;
    enum status status = job_create(&options->job, options->scenes[0], &job);
    if (status != STATUS_DONE)
        return status;
    status = float_limit_warn(&job);
    job.plan.bound_truncation = options->job.has_max_error || options_exr_outputs(options) > 0;
    double start = clock_ms();
    if (status == STATUS_DONE && options->backend == BACKEND_VULKAN)
        status = vulkan_context_create(&options->vulkan, &context);
    double context_ms = context ? clock_ms() - start : 0;
    if (status == STATUS_DONE)
        status =
            context ? render_on_device(context, &job.plan, &rendering) : render_on_cpu(&job.plan, &rendering);
    if (status == STATUS_DONE) {
        rendering.setup_ms += context_ms;
        if (context && !job.plan.fast && !job.plan.shaders)
            status = spot_check(&job.plan, &rendering.image, context->properties.deviceName);
        if (status == STATUS_DONE)
            status = deliver(options, &job, &rendering, context);
        image_destroy(&rendering.image);
    }
    job_destroy(&job);
    enum status closed = vulkan_context_destroy(&context);
    return status == STATUS_DONE ? closed : status;
}
