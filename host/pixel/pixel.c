#include "pixel/pixel.h"

#include "base/output_file.h"
#include "pixel/trace.h"

static enum status choose_pixel(const struct pixel_options *options, struct job *job)
{
    job->plan.window = (struct window){options->x, options->y, 1, 1};
    job->plan.quiet = true;
    if (options->x < (unsigned)job->packed.width && options->y < (unsigned)job->packed.height)
        return STATUS_DONE;
    log_error("pixel %u %u: expected a column from 0 to %d and a row from 0 to %d", options->x, options->y,
              job->packed.width - 1, job->packed.height - 1);
    return STATUS_REFUSED;
}

static enum status trace_and_show(const struct pixel_options *options, struct vulkan_context *context,
                                  const struct job *job)
{
    struct pixel_trace trace;
    enum status status = pixel_trace_create(context, job, options->against, &trace);
    if (status != STATUS_DONE)
        return status;
    if (!options->job.quiet)
        pixel_print(&trace, options->all_light_samples);
    pixel_print_verdict(&trace);
    if (options->json)
        status = json_write(pixel_json(&trace), options->json);
    if (status == STATUS_DONE && (trace.difference.differs || !trace.is_the_pictures))
        status = STATUS_DIFFERS;
    pixel_trace_destroy(&trace);
    return status;
}

enum status pixel_show(const struct pixel_options *options)
{
    struct vulkan_context *context = NULL;
    struct job job;
    enum status status = options->json ? output_file_check(options->json) : STATUS_DONE;
    if (status == STATUS_DONE)
        status = job_create(&options->job, options->scene, &job);
    if (status != STATUS_DONE)
        return status;
    status = choose_pixel(options, &job);
    if (status == STATUS_DONE)
        status = vulkan_context_create(&options->vulkan, &context);
    if (status == STATUS_DONE)
        status = trace_and_show(options, context, &job);
    job_destroy(&job);
    enum status closed = vulkan_context_destroy(&context);
    return status > closed ? status : closed;
}
