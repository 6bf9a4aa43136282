#ifndef VKWHITTED_BENCH_MACHINE_H
#define VKWHITTED_BENCH_MACHINE_H

#include <jansson.h>

#include "vulkan/context.h"

/* What a measurement was made on, as an object with "processor", "cores", "memory_gib", "os", "compiler" and,
 * with a context, "device", "driver" and "vulkan". NULL without memory. */
json_t *machine_describe(const struct vulkan_context *context);

#endif
