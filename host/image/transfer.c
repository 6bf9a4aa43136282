#include "image/transfer.h"

#include <math.h>

#include "base/float_bits.h"

static const float lowest = 0x1p-13f;

/* By the transfer function of IEC 61966-2-1:1999, section 5.2. */
static unsigned nearest_code(enum transfer transfer, float linear)
{
    const double x = (double)linear;
    const double encoded = transfer == TRANSFER_LINEAR ? x
                           : x <= 0.0031308            ? 12.92 * x
                                                       : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (unsigned)floor(255.0 * encoded + 0.5);
}

void transfer_encoder_init(enum transfer transfer, struct transfer_encoder *encoder)
{
    for (uint32_t cell = 0; cell < TRANSFER_CELLS; cell++) {
        uint32_t below = float_bits(lowest) + (cell << 16), above = below + 0xffff;
        const unsigned code = nearest_code(transfer, float_of_bits(below));
        const bool rises = nearest_code(transfer, float_of_bits(above)) > code;
        while (rises && above - below > 1) {
            const uint32_t middle = below + (above - below) / 2;
            if (nearest_code(transfer, float_of_bits(middle)) > code)
                above = middle;
            else
                below = middle;
        }
        encoder->cells[cell].below = code;
        encoder->cells[cell].threshold = rises ? float_of_bits(above) : INFINITY;
    }
}

void transfer_encode(const struct transfer_encoder *encoder, const float *linear, size_t count,
                     uint8_t *encoded)
{
    const uint32_t first = float_bits(lowest);
    for (size_t i = 0; i < count; i++) {
        float value = linear[i] > lowest ? linear[i] : lowest; /* false for NaN */
        value = value < 1.0f ? value : 1.0f;
        uint32_t cell = (float_bits(value) - first) >> 16;
        encoded[i] = (uint8_t)(encoder->cells[cell].below + (value >= encoder->cells[cell].threshold));
    }
}
