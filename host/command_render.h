#ifndef VKWHITTED_COMMAND_RENDER_H
#define VKWHITTED_COMMAND_RENDER_H

#include "options.h"

/* vkwhitted render */
enum status command_render(const struct options *options);

#endif
