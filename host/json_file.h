#ifndef VKWHITTED_JSON_FILE_H
#define VKWHITTED_JSON_FILE_H

#include <jansson.h>

#include "status.h"

/* Writes the value to a file, whole or not at all, and releases it. NULL stands for "no memory". */
enum status json_write(json_t *value, const char *path);

#endif
