#ifndef VKWHITTED_CLI_COMMAND_WATCH_H
#define VKWHITTED_CLI_COMMAND_WATCH_H

#include "cli/options.h"

/* vkwhitted watch: keeps the picture current while the scene file and the shader change, until Ctrl-C. */
enum status command_watch(const struct options *options);

#endif
