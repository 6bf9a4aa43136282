#include "cli/options.h"

#include "base/json.h"
#include "base/output_file.h"
#include "pixel/report.h"
#include "tracer/job.h"

/* The pixel as the picture has it. */
static enum status render_pixel(struct vulkan_context *context, const struct render_plan *plan, double rgb[3])
{
    struct rendering rendering;
    enum status status =
        context ? render_on_device(context, plan, &rendering) : render_on_cpu(plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    const struct image *image = &rendering.image;
    for (int c = 0; c < 3; ++c)
        rgb[c] = image->rgb64 ? image->rgb64[c] : (double)image->rgb[c];
    image_destroy(&rendering.image);
    return STATUS_DONE;
}

static enum status trace_all(struct vulkan_context *context, const struct render_plan *plan,
                             struct pixel_report *report)
{
    enum status status = pixel_events_on_cpu(plan, PRECISION_FLOAT, &report->reference);
    if (status == STATUS_DONE && report->against != PRECISION_FLOAT)
        status = pixel_events_on_cpu(plan, report->against, &report->exact);
    if (status == STATUS_DONE)
        status = pixel_events_on_device(
            context, plan, report->reference.count + report->reference.beyond + 1024, &report->on_device);
    if (status == STATUS_DONE)
        status = render_pixel(context, plan, report->picture);
    if (status == STATUS_DONE)
        status = render_pixel(NULL, plan, report->reference_picture);
    return status;
}

static enum status show(const struct options *options, const struct pixel_report *report)
{
    enum status status = STATUS_DONE;
    if (!options->job.quiet)
        status = pixel_print(report, options->verbose);
    if (status == STATUS_DONE)
        pixel_print_verdict(report);
    if (status == STATUS_DONE && options->json)
        status = json_write(pixel_json(report), options->json);
    if (status == STATUS_DONE && (report->difference.differs || !pixel_is_the_pictures(report)))
        status = STATUS_DIFFERS;
    return status;
}

static enum status check_place(const struct options *options, const struct job *job)
{
    if (options->x < (unsigned)job->packed.width && options->y < (unsigned)job->packed.height)
        return STATUS_DONE;
    log_error("pixel %u %u: expected a column from 0 to %d and a row from 0 to %d", options->x, options->y,
              job->packed.width - 1, job->packed.height - 1);
    return STATUS_REFUSED;
}

static enum status report_pixel(const struct options *options, struct vulkan_context *context,
                                struct job *job)
{
    job->plan.window = (struct window){options->x, options->y, 1, 1};
    job->plan.quiet = true;
    struct pixel_report report = {
        .scene_path = options->scenes[0],
        .device = context->properties.deviceName,
        .driver = context->driver.driverInfo,
        .scene = &job->scene,
        .packed = &job->packed,
        .scale = pack_scale(&job->scene),
        .x = options->x,
        .y = options->y,
        .precision = options->job.precision,
        .against = options->against,
    };
    enum status status = trace_all(context, &job->plan, &report);
    if (status == STATUS_DONE) {
        report.difference = events_compare(&report.on_device, &report.reference);
        status = show(options, &report);
    }
    pixel_events_destroy(&report.on_device);
    pixel_events_destroy(&report.reference);
    pixel_events_destroy(&report.exact);
    return status;
}

enum status command_pixel(const struct options *options)
{
    struct vulkan_context *context = NULL;
    struct job job;
    enum status status = options->json ? output_file_check(options->json) : STATUS_DONE;
    if (status == STATUS_DONE)
        status = job_create(&options->job, options->scenes[0], &job);
    if (status != STATUS_DONE)
        return status;
    status = check_place(options, &job);
    if (status == STATUS_DONE)
        status = vulkan_context_create(&options->vulkan, &context);
    if (status == STATUS_DONE)
        status = report_pixel(options, context, &job);
    job_destroy(&job);
    enum status closed = vulkan_context_destroy(&context);
    return status > closed ? status : closed;
}
