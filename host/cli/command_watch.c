#include "cli/options.h"

#include "watch/watch.h"

enum status command_watch(const struct options *options)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < options->output_count && status == STATUS_DONE; ++i)
        status = image_write_check(options->outputs[i]);
    if (status != STATUS_DONE)
        return status;
    return watch(&(struct watch_options){
        .scene = options->scenes[0],
        .shader_folder = options->shaders,
        .outputs = options->outputs,
        .output_count = options->output_count,
        .transfer = options->transfer,
        .vulkan = options->vulkan,
        .job = options->job,
        .check = options->check,
        .window = options->window,
    });
}
