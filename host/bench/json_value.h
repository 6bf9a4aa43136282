#ifndef VKWHITTED_BENCH_JSON_VALUE_H
#define VKWHITTED_BENCH_JSON_VALUE_H

#include <jansson.h>

/* The number at a key of an object, NAN where there is no object, no such key or no number. */
double json_number_at(const json_t *object, const char *key);

/* The string at a key of an object, "" where there is none. Lives as long as the object. */
const char *json_text_at(const json_t *object, const char *key);

#endif
