#include "vulkan/probe.h"

#include "base/float_bits.h"

enum { LEAST_EXPONENT = 1, BIAS = 127, GREATEST_EXPONENT = 254 };

uint32_t random_word(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)((z ^ z >> 31) >> 32);
}

/* mantissa: 24 bits, the first of which is implied; exponent: biased. */
static float assemble(uint32_t mantissa, uint32_t exponent)
{
    return float_of_bits(exponent << 23 | (mantissa & 0x7fffff));
}

static uint32_t random_between(uint64_t *state, uint32_t least, uint32_t greatest)
{
    return least + random_word(state) % (greatest - least + 1);
}

static float random_float(uint64_t *state, uint32_t least_exponent, uint32_t greatest_exponent)
{
    float value = assemble(random_word(state), random_between(state, least_exponent, greatest_exponent));
    return random_word(state) & 1 ? value : -value;
}

/* Modulo 2^32, of an odd number; each of Newton's steps doubles the right bits, of which x has three. */
static uint32_t inverse(uint32_t x)
{
    uint32_t y = x;
    for (int i = 0; i < 4; ++i)
        y *= 2 - x * y;
    return y;
}

/* a / b = (m +- 1 / b's mantissa) 2^k, m odd and of 25 bits: as near to a middle as a quotient can be. The
 * dividend is the multiple of 2^24 next to m times the divisor. */
static void hard_quotient(uint64_t *state, float *a, float *b)
{
    for (;;) {
        uint32_t divisor = random_between(state, UINT32_C(1) << 23, (UINT32_C(1) << 24) - 1) | 1;
        uint32_t above = random_word(state) & 1;
        uint32_t middle = (above ? 0 - inverse(divisor) : inverse(divisor)) & 0xffffff;
        uint64_t product = (UINT64_C(0x1000000) + middle) * divisor;
        uint32_t dividend = (uint32_t)((above ? product + 1 : product - 1) >> 24);
        uint32_t longer = dividend >> 24; /* 25 bits: the last must be 0 */
        if (dividend < UINT32_C(1) << 23 || (longer && (dividend & 1)))
            continue;
        uint32_t exponent = random_between(state, 64, 190);
        *a = assemble(dividend >> longer, exponent + longer);
        *b = assemble(divisor, random_between(state, 64, 190));
        return;
    }
}

/* The square of (s + 1/2) 2^k, off by some d - 1/4: s^2 + s + d has to end in 23 or 24 zeros, for which
 * Newton's steps modulo a power of two find s. */
static float hard_root(uint64_t *state)
{
    for (;;) {
        uint32_t d = (random_word(state) % 64 - 32) * 2;
        uint32_t s = random_word(state);
        uint32_t shift = 23 + (random_word(state) & 1);
        for (int i = 0; i < 6; ++i)
            s -= (s * s + s + d) * inverse(2 * s + 1);
        s = (s & 0x7fffff) | UINT32_C(1) << 23 | (shift == 24 ? s & 0x800000 : 0);
        uint64_t square = (uint64_t)s * s + s + (uint64_t)(int64_t)(int32_t)d;
        if (square & ((UINT64_C(1) << shift) - 1) || square >> (shift + 23) != 1)
            continue;
        uint32_t exponent = random_between(state, LEAST_EXPONENT, GREATEST_EXPONENT - 1);
        exponent += (exponent & 1) ^ (shift == 23); /* odd for 23 */
        return assemble((uint32_t)(square >> shift), exponent);
    }
}

static float edge(uint64_t *state)
{
    static const uint32_t mantissas[] = {0,        1,        2,        3,        0x3fffff,
                                         0x400000, 0x400001, 0x555555, 0x7ffffe, 0x7fffff};
    static const uint32_t exponents[] = {LEAST_EXPONENT,   2, 24, 64, 126, BIAS, 128, 129, 190, 253,
                                         GREATEST_EXPONENT};
    float value = assemble(mantissas[random_word(state) % (sizeof mantissas / sizeof *mantissas)],
                           exponents[random_word(state) % (sizeof exponents / sizeof *exponents)]);
    return random_word(state) & 1 ? value : -value;
}

void hostile_operands(uint64_t seed, struct operands *operands, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        struct operands *next = &operands[i];
        switch (i % 4) {
        case 0:
            next->a = random_float(&seed, LEAST_EXPONENT, GREATEST_EXPONENT);
            next->b = random_float(&seed, LEAST_EXPONENT, GREATEST_EXPONENT);
            next->c = random_float(&seed, LEAST_EXPONENT, GREATEST_EXPONENT);
            break;
        case 1:
            hard_quotient(&seed, &next->a, &next->b);
            next->c = -(next->a * next->b);
            break;
        case 2:
            next->a = i % 8 == 2 ? hard_root(&seed) : random_float(&seed, BIAS - 3, BIAS + 3);
            next->b = random_float(&seed, BIAS - 3, BIAS + 3);
            next->c = next->a * random_float(&seed, BIAS - 6, BIAS + 6);
            break;
        default:
            next->a = edge(&seed);
            next->b = edge(&seed);
            next->c = edge(&seed);
        }
    }
}
