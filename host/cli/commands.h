#ifndef VKWHITTED_CLI_COMMANDS_H
#define VKWHITTED_CLI_COMMANDS_H

#include "base/status.h"

struct options;

enum command_id {
    COMMAND_RENDER,
    COMMAND_CHECK,
    COMMAND_WATCH,
    COMMAND_BENCH,
    COMMAND_PIXEL,
    COMMAND_DEVICES,
    COMMAND_COUNT
};

/* What is reported on standard output and error, and what the exit status means, stands in the manual page.
 */
enum status command_render(const struct options *options);
enum status command_check(const struct options *options);
enum status command_watch(const struct options *options);
enum status command_bench(const struct options *options);
enum status command_pixel(const struct options *options);
enum status command_devices(const struct options *options);

struct command {
    const char *name, *arguments, *summary;
    enum status (*run)(const struct options *options);
};
extern const struct command commands[COMMAND_COUNT];

enum { COMMAND_NAMES = 64 }; /* characters that the names of all commands take */

/* Writes the names of a set of commands, in which 1 << COMMAND_... are the bits, separated by ", ". */
const char *command_names(unsigned set, char names[static COMMAND_NAMES]);

#endif
