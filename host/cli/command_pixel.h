#ifndef VKWHITTED_CLI_COMMAND_PIXEL_H
#define VKWHITTED_CLI_COMMAND_PIXEL_H

#include "cli/options.h"

/* vkwhitted pixel: the ray tree of one pixel, on the device and with the reference. STATUS_DIFFERS where they
 * part. */
enum status command_pixel(const struct options *options);

#endif
