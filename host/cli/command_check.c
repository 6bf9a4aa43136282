#include "cli/options.h"

#include <math.h>
#include <stdio.h>

#include "base/json.h"
#include "base/output_file.h"
#include "cli/check_against.h"
#include "tracer/job.h"

static enum status worse(enum status a, enum status b)
{
    return a > b ? a : b;
}

static enum status report(const struct options *options, const char *scene, const struct rendering *rendering,
                          const struct comparison *comparison, json_t *results)
{
    static const char *const channels[] = {"r", "g", "b"};
    const struct image *image = &rendering->image;
    bool agrees = comparison->differing <= options->allow;
    printf("%s: %zu of %zu pixels differ, max error %.9g @ (%u, %u, %s)%s\n", scene, comparison->differing,
           (size_t)image->width * image->height, comparison->max_error, comparison->x, comparison->y,
           channels[comparison->channel], agrees ? "" : "  DIFFERS");
    enum status status = agrees ? STATUS_DONE : STATUS_DIFFERS;
    if (!options->json)
        return status;
    /* JSON has no infinity. */
    json_t *max_error = isfinite(comparison->max_error) ? json_real(comparison->max_error) : json_null();
    json_t *result =
        json_pack("{s:s, s:b, s:i, s:i, s:I, s:I, s:o, s:{s:i, s:i, s:s}}", "scene", scene, "agrees", agrees,
                  "width", (int)image->width, "height", (int)image->height, "differing_pixels",
                  (json_int_t)comparison->differing, "bit_differing_pixels",
                  (json_int_t)comparison->bit_differing, "max_error", max_error, "at", "x",
                  (int)comparison->x, "y", (int)comparison->y, "channel", channels[comparison->channel]);
    if (json_array_append_new(results, result) != 0) {
        log_error("no memory for the result of %s, or its name is not UTF-8", scene);
        return STATUS_UNABLE;
    }
    return status;
}

static enum status compare_renderings(const struct options *options, const char *scene,
                                      const struct rendering *device, const struct rendering *reference,
                                      json_t *results)
{
    struct comparison comparison;
    enum status status = image_compare(&device->image, &reference->image,
                                       options->has_tolerance ? &options->tolerance : NULL, &comparison);
    if (status != STATUS_DONE && status != STATUS_DIFFERS)
        return status;
    status = report(options, scene, device, &comparison, results);
    if (options->heatmap)
        status = worse(status, heatmap_write(&device->image, &reference->image, options->heatmap));
    return status;
}

static enum status check_scene(const struct options *options, struct vulkan_context *context,
                               const char *scene, json_t *results)
{
    struct job job;
    struct rendering device, reference;
    enum status status = job_create(&options->job, scene, &job);
    if (status != STATUS_DONE)
        return status;
    if (options->against != PRECISION_FLOAT) {
        status = check_against(options, context, scene, &job, results);
        job_destroy(&job);
        return status;
    }
    status = render_on_device(context, &job.plan, &device);
    if (status == STATUS_DONE) {
        status = render_on_cpu(&job.plan, &reference);
        if (status == STATUS_DONE) {
            status = compare_renderings(options, scene, &device, &reference, results);
            image_destroy(&reference.image);
        }
        image_destroy(&device.image);
    }
    job_destroy(&job);
    return status;
}

static enum status check_outputs(const struct options *options)
{
    enum status status = STATUS_DONE;
    if (options->heatmap)
        status = output_file_check(options->heatmap);
    if (status == STATUS_DONE && options->json)
        status = output_file_check(options->json);
    return status;
}

enum status command_check(const struct options *options)
{
    struct vulkan_context *context = NULL; /* stays so with --backend cpu */
    enum status status = check_outputs(options);
    if (status == STATUS_DONE && options->backend == BACKEND_VULKAN)
        status = vulkan_context_create(&options->vulkan, &context);
    if (status != STATUS_DONE)
        return status;
    json_t *results = json_array();
    for (size_t i = 0; i < options->scene_count && status != STATUS_INTERRUPTED; ++i)
        status = worse(status, check_scene(options, context, options->scenes[i], results));
    if (options->json && status != STATUS_INTERRUPTED) {
        json_t *document =
            json_pack("{s:s, s:s, s:O}", "device", context ? context->properties.deviceName : "cpu", "driver",
                      context ? context->driver.driverInfo : "plain-C reference", "scenes", results);
        status = worse(status, json_write(document, options->json));
    }
    json_decref(results);
    return worse(status, vulkan_context_destroy(&context));
}
