#ifndef VKWHITTED_BASE_FLOAT_BITS_H
#define VKWHITTED_BASE_FLOAT_BITS_H

#include <stdint.h>
#include <string.h>

/* A float as the word that holds it, and back. */
static inline uint32_t float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline float float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
