#include "cli/options.h"

#include "pixel/trace.h"

/* STATUS_DIFFERS where device and reference disagree, or where the picture's pipeline makes another pixel
 * than the recording one. */
static enum status show(const struct options *options, struct vulkan_context *context, const struct job *job)
{
    struct pixel_trace trace;
    enum status status = pixel_trace_create(context, job, options->against, &trace);
    if (status != STATUS_DONE)
        return status;
    if (!options->job.plan.quiet)
        pixel_print(&trace, options->verbose);
    pixel_print_verdict(&trace);
    if (options->json)
        status = json_write(pixel_json(&trace), options->json);
    if (status == STATUS_DONE && (trace.difference.differs || !trace.is_the_pictures))
        status = STATUS_DIFFERS;
    pixel_trace_destroy(&trace);
    return status;
}

enum status command_pixel(const struct options *options)
{
    struct vulkan_context *context = NULL;
    struct job job;
    enum status status = job_create(&options->job, options->scenes[0], &job);
    if (status != STATUS_DONE)
        return status;
    job.plan.window = (struct window){options->x, options->y, 1, 1};
    job.plan.quiet = true;
    if (options->x >= (unsigned)job.packed.width || options->y >= (unsigned)job.packed.height) {
        log_error("pixel %u %u: expected a column from 0 to %d and a row from 0 to %d", options->x,
                  options->y, job.packed.width - 1, job.packed.height - 1);
        status = STATUS_REFUSED;
    }
    if (status == STATUS_DONE)
        status = vulkan_context_create(&options->vulkan, &context);
    if (status == STATUS_DONE)
        status = show(options, context, &job);
    job_destroy(&job);
    enum status closed = vulkan_context_destroy(&context);
    return status > closed ? status : closed;
}
