#ifndef VKWHITTED_CLI_COMMAND_LINE_H
#define VKWHITTED_CLI_COMMAND_LINE_H

#include "cli/options.h"

/* Reads the command line; argc is at least 2. STATUS_REFUSED (reported) if it is wrong, STATUS_UNABLE if an
 * output cannot be written. The caller frees the options with command_line_destroy(), also on failure. */
enum status command_line_read(int argc, char **argv, struct options *options);
void command_line_destroy(struct options *options);

#endif
