#include "cli/commands.h"
#include "cli/options.h"
#include "vulkan/probe.h"

enum status command_devices(const struct options *options)
{
    return vulkan_print_devices(&options->vulkan, probe_print);
}
