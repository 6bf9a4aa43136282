#ifndef VKWHITTED_CLI_COMMAND_BENCH_H
#define VKWHITTED_CLI_COMMAND_BENCH_H

#include "cli/options.h"

/* vkwhitted bench: speed and error of every scene. STATUS_DIFFERS where --compare finds that something became
 * slower or less accurate. */
enum status command_bench(const struct options *options);

#endif
