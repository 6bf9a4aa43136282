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

/* Operands for arithmetic that may round wrongly: a / b, sqrt(a), a + b, a * b + c. */
struct operands {
    float a, b, c;
};

/* 32 random bits; any state is a good start (Steele et al., "Fast Splittable Pseudorandom Number Generators",
 * OOPSLA 2014). */
uint32_t random_word(uint64_t *state);

/* Normal numbers of both signs (a >= 0 in a quarter of the cases: for the root), the same for the same seed:
 * in turn any bits; a / b next to the middle between two floats and c = -(a b), rounded; sqrt(a) next to such
 * a middle and three numbers of similar size; pairs of powers of two and of the numbers next to them, the
 * smallest and the largest included. */
void hostile_operands(uint64_t seed, struct operands *operands, size_t count);

#endif
