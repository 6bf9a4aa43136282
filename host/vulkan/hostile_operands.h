#ifndef VKWHITTED_VULKAN_HOSTILE_OPERANDS_H
#define VKWHITTED_VULKAN_HOSTILE_OPERANDS_H

#include <stddef.h>
#include <stdint.h>

/* Operands for arithmetic that may round wrongly: a / b, sqrt(a), a + b, a * b + c. */
struct operands {
    float a, b, c;
};

/* 32 random bits; any state is a good start (Steele et al., "Fast Splittable Pseudorandom Number Generators",
 * OOPSLA 2014). */
uint32_t random_bits(uint64_t *state);

/* Normal numbers of both signs (a >= 0 in a quarter of the cases: for the root), the same for the same seed:
 * in turn any bits; a / b next to the middle between two floats and c = -(a b), rounded; sqrt(a) next to such
 * a middle and three numbers of similar size; pairs of powers of two and of the numbers next to them, the
 * smallest and the largest included. */
void hostile_operands(uint64_t seed, struct operands *operands, size_t count);

#endif
