#ifndef VKWHITTED_IMAGE_SRGB_H
#define VKWHITTED_IMAGE_SRGB_H

#include <stddef.h>
#include <stdint.h>

/* From linear light to the 8-bit code values of IEC 61966-2-1 (sRGB): the nearest integer to 255 E(x),
 * E(x) = 12.92 x up to 0.0031308 and 1.055 x^(1/2.4) - 0.055 above, x first clamped to [0, 1]; NaN is 0.
 *
 * The encoder gives what the formula gives in double, for every float. Floats are sorted into cells by
 * exponent and 7 bits of mantissa: so narrow that the code value rises at most once inside a cell (it
 * rises fastest, by 0.66, from 0.5 to 0.5 (1 + 1/128)). */
enum {
    SRGB_CELLS_PER_OCTAVE = 128,
    SRGB_OCTAVES = 13, /* below 2^-13 the code value is 0 */
    SRGB_CELLS = SRGB_OCTAVES * SRGB_CELLS_PER_OCTAVE + 1,
};

struct srgb_encoder {
    struct {
        float threshold; /* the least float in the cell that encodes to below + 1; infinity if none does */
        uint32_t below;  /* the code value at the cell's lower end */
    } cells[SRGB_CELLS];
};

void srgb_encoder_init(struct srgb_encoder *encoder);

/* count channel values to count bytes. */
void srgb_encode(const struct srgb_encoder *encoder, const float *linear, size_t count, uint8_t *encoded);

/* The same without the transfer function: the nearest integer to 255 x, clamped, NaN is 0. */
void linear_encode(const float *linear, size_t count, uint8_t *encoded);

#endif
