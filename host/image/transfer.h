#ifndef VKWHITTED_IMAGE_TRANSFER_H
#define VKWHITTED_IMAGE_TRANSFER_H

#include <stddef.h>
#include <stdint.h>

#include "image/image.h"

/* From linear light to 8-bit code values: the nearest integer to 255 E(x), x first clamped to [0, 1]; NaN is
 * 0. Linear, E(x) = x; for IEC 61966-2-1 (sRGB), E(x) = 12.92 x up to 0.0031308 and 1.055 x^(1/2.4) - 0.055
 * above.
 *
 * The encoder gives what the formula gives in double, for every float. Floats are sorted into cells by
 * exponent and 7 bits of mantissa: so narrow that the code value rises at most once inside a cell (it
 * rises fastest, by 0.996, where it is linear, from 0.5 to 0.5 (1 + 1/128)). */
enum {
    CELLS_PER_OCTAVE = 128,
    OCTAVES = 13, /* below 2^-13 the code value is 0 */
    TRANSFER_CELLS = OCTAVES * CELLS_PER_OCTAVE + 1,
};

struct transfer_encoder {
    struct {
        float threshold; /* the least float in the cell that encodes to below + 1; infinity if none does */
        uint32_t below;  /* the code value at the cell's lower end */
    } cells[TRANSFER_CELLS];
};

void transfer_encoder_init(enum transfer transfer, struct transfer_encoder *encoder);

/* count channel values to count bytes. */
void transfer_encode(const struct transfer_encoder *encoder, const float *linear, size_t count,
                     uint8_t *encoded);

#endif
