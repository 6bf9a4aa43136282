#ifndef VKWHITTED_CLI_CHECK_AGAINST_H
#define VKWHITTED_CLI_CHECK_AGAINST_H

#include "base/json.h"
#include "cli/options.h"

/* vkwhitted check --against: the scene on the device (or, without a context, with the reference's float
 * build) against the exact picture. Prints a line and adds it to results. STATUS_DIFFERS where more than the
 * allowed number of pixels are unexplained. */
enum status check_against(const struct options *options, struct vulkan_context *context, const char *scene,
                          const struct job *job, json_t *results);

#endif
