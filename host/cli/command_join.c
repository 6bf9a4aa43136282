#include "cli/options.h"

#include "image/join.h"

enum status command_join(const struct options *options)
{
    return join_tiles((const char *const *)options->scenes, options->scene_count, options->outputs,
                      options->output_count, options->transfer);
}
