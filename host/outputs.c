#include "outputs.h"

enum status outputs_check(const struct options *options)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < options->output_count && status == STATUS_DONE; ++i)
        status = image_write_check(options->outputs[i]);
    return status;
}

enum status outputs_write(const struct options *options, const struct job *job, const struct image *image,
                          const char *device)
{
    const struct image_metadata metadata = {
        .transfer = options->transfer,
        .scene = options->scenes[0],
        .device = device,
        .precision = precision_name(options->precision),
        .max_bounces = job->max_bounces,
    };
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < options->output_count && status == STATUS_DONE; ++i)
        status =
            interrupt_requested() ? STATUS_INTERRUPTED : image_write(image, options->outputs[i], &metadata);
    return status;
}
