/* The first two dimensions of Sobol's sequence, shuffled and Owen-scrambled (Burley, "Practical Hash-based
 * Owen Scrambling", JCGT 9(4), 2020). All in integers, so that every precision draws the same points. */
#ifndef REFERENCE_SOBOL_H
#define REFERENCE_SOBOL_H

#include <stdint.h>

#include "real.h"

/* C. Wellons, "Prospecting for hash functions": lowbias32. */
static inline uint32_t hash32(uint32_t x)
{
    x ^= x >> 16;
    x *= UINT32_C(0x7feb352d);
    x ^= x >> 15;
    x *= UINT32_C(0x846ca68b);
    x ^= x >> 16;
    return x;
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & UINT32_C(0x00ff00ff)) | ((x & UINT32_C(0x00ff00ff)) << 8);
    x = ((x >> 4) & UINT32_C(0x0f0f0f0f)) | ((x & UINT32_C(0x0f0f0f0f)) << 4);
    x = ((x >> 2) & UINT32_C(0x33333333)) | ((x & UINT32_C(0x33333333)) << 2);
    return ((x >> 1) & UINT32_C(0x55555555)) | ((x & UINT32_C(0x55555555)) << 1);
}

/* Nested uniform (Owen) scrambling; the hash works on reversed bits (N. Vegdahl, "Building a Better LK
 * Hash", 2021). */
static inline uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    x = reverse_bits(x);
    x ^= x * UINT32_C(0x3d20adea);
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * UINT32_C(0x05526c56);
    x ^= x * UINT32_C(0x53a22864);
    return reverse_bits(x);
}

/* Dimension 2 of the sequence by its direction numbers v_0 = 2^31, v_(k+1) = v_k xor v_k / 2. */
static inline uint32_t sobol_second(uint32_t index)
{
    uint32_t point = 0;
    for (uint32_t direction = UINT32_C(1) << 31; index != 0; index >>= 1, direction ^= direction >> 1)
        if (index & 1)
            point ^= direction;
    return point;
}

/* Point `index` of the sequence that belongs to seed, u and v in [0, 1), multiples of 2^-24. */
static inline void sobol_point(uint32_t seed, uint32_t index, real *u, real *v)
{
    uint32_t first = owen_scramble(reverse_bits(index), hash32(hash32(seed) + 1));
    uint32_t second = owen_scramble(sobol_second(index), hash32(hash32(seed) + 2));
    *u = (real)(first >> 8) * (real)0x1p-24;
    *v = (real)(second >> 8) * (real)0x1p-24;
}

/* The numbers in another order, such that blocks stay together whose sizes are powers of two. */
static inline uint32_t sobol_shuffle(uint32_t seed, uint32_t number)
{
    return owen_scramble(number, hash32(seed));
}

/* The first of a block of at least so many points of a light, one block for each sample of the pixel. */
static inline uint32_t sobol_block(uint32_t seed, uint32_t pixel_sample, int points)
{
    uint32_t first = sobol_shuffle(seed, pixel_sample);
    for (int size = 1; size < points; size *= 2)
        first *= 2;
    return first;
}

#endif
