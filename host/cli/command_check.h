#ifndef VKWHITTED_CLI_COMMAND_CHECK_H
#define VKWHITTED_CLI_COMMAND_CHECK_H

#include "cli/options.h"

/* vkwhitted check: every scene on the device and with the reference's float build. STATUS_DIFFERS where more
 * than the allowed number of pixels disagree. A scene that cannot be compared does not keep the others from
 * it. */
enum status command_check(const struct options *options);

#endif
