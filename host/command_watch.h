#ifndef VKWHITTED_COMMAND_WATCH_H
#define VKWHITTED_COMMAND_WATCH_H

#include "options.h"

/* vkwhitted watch: keeps the picture current while the scene file and the shader change, until Ctrl-C. */
enum status command_watch(const struct options *options);

#endif
