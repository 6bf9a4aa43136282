#include "cli/options.h"

#include "pixel/pixel.h"

enum status command_pixel(const struct options *options)
{
    return pixel_show(&(struct pixel_options){
        .scene = options->scenes[0],
        .x = options->x,
        .y = options->y,
        .vulkan = options->vulkan,
        .job = options->job,
        .against = options->against,
        .all_light_samples = options->verbose,
        .json = options->json,
    });
}
