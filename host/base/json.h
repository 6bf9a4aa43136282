#ifndef VKWHITTED_BASE_JSON_H
#define VKWHITTED_BASE_JSON_H

#include <jansson.h>

#include "base/status.h"

/* The number; null where it is not finite, which JSON cannot say. */
json_t *json_real_or_null(double value);

/* Writes the value to a file, whole or not at all, and releases it. NULL stands for "no memory". */
enum status json_write(json_t *value, const char *path);

#endif
