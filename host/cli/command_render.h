#ifndef VKWHITTED_CLI_COMMAND_RENDER_H
#define VKWHITTED_CLI_COMMAND_RENDER_H

#include "cli/options.h"

/* vkwhitted render */
enum status command_render(const struct options *options);

#endif
