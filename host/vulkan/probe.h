#ifndef VKWHITTED_VULKAN_PROBE_H
#define VKWHITTED_VULKAN_PROBE_H

#include <stddef.h>

#include "vulkan/context.h"

/* Finds out what arithmetic on the context's device does, by some sixty thousand operations on numbers that
 * are hard to round, compared with the processor's. Fills context->arithmetic; later calls change nothing.
 *
 * Only normal numbers and zeros count, as operands, results and on the way: the tracer depends on no others.
 * Failures, of Vulkan only, are reported. */
enum status probe_arithmetic(struct vulkan_context *context);

/* Probes, and reports and refuses (STATUS_UNABLE) a device on which no correction makes pictures exact. */
enum status probe_require_exact(struct vulkan_context *context);

/* Probes, and prints what was found in a line, such as "arithmetic  / exact, sqrt exact, no contraction:
 * native". */
enum status probe_print(struct vulkan_context *context);

#endif
