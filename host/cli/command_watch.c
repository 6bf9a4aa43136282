#include "cli/options.h"

#include "watch/watch.h"

enum status command_watch(const struct options *options)
{
    return watch(&(struct watch_options){
        .scene = options->scenes[0],
        .shader_folder = options->shaders.path,
        .outputs = options->outputs,
        .output_count = options->output_count,
        .transfer = options->transfer,
        .vulkan = options->vulkan,
        .job = options->job,
        .check = options->check,
        .window = options->window,
    });
}
