#ifndef VKWHITTED_CLI_HELP_H
#define VKWHITTED_CLI_HELP_H

#include <stdio.h>

#include "base/status.h"

/* Both return STATUS_UNABLE (reported) if the text cannot be written. */
enum status help_print(FILE *stream);
enum status help_print_version(void);

#endif
