#ifndef VKWHITTED_CLI_HELP_H
#define VKWHITTED_CLI_HELP_H

#include <stdio.h>

/* The caller finds out by fflush() whether the text could be written. documents.cmake reads it, too. */
void help_print(FILE *stream);
void help_print_version(void);

#endif
