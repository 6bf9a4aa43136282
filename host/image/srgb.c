#include "image/srgb.h"

#include <math.h>
#include <string.h>

static const float lowest = 0x1p-13f;

static uint32_t float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* IEC 61966-2-1:1999, section 5.2. */
static double opto_electronic_transfer(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

static double inverse_transfer(double encoded)
{
    return encoded <= 12.92 * 0.0031308 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

static unsigned nearest_code(float linear)
{
    return (unsigned)floor(255.0 * opto_electronic_transfer((double)linear) + 0.5);
}

/* The least float that encodes to code or more: the inverse is right to within a few floats, the rest
 * is walked. */
static float threshold_of(unsigned code)
{
    float threshold = (float)inverse_transfer((code - 0.5) / 255.0);
    while (nearest_code(threshold) >= code)
        threshold = nextafterf(threshold, 0.0f);
    while (nearest_code(threshold) < code)
        threshold = nextafterf(threshold, 1.0f);
    return threshold;
}

void srgb_encoder_init(struct srgb_encoder *encoder)
{
    uint32_t code = 0;
    float threshold = threshold_of(1);
    for (uint32_t cell = 0; cell < SRGB_CELLS; cell++) {
        float end = float_of_bits(float_bits(lowest) + ((cell + 1) << 16));
        encoder->cells[cell].below = code;
        encoder->cells[cell].threshold = INFINITY;
        if (code < 255 && threshold < end) {
            encoder->cells[cell].threshold = threshold;
            code++;
            threshold = code < 255 ? threshold_of(code + 1) : INFINITY;
        }
    }
}

void srgb_encode(const struct srgb_encoder *encoder, const float *linear, size_t count, uint8_t *encoded)
{
    const uint32_t first = float_bits(lowest);
    for (size_t i = 0; i < count; i++) {
        float value = linear[i] > lowest ? linear[i] : lowest; /* false for NaN */
        value = value < 1.0f ? value : 1.0f;
        uint32_t cell = (float_bits(value) - first) >> 16;
        encoded[i] = (uint8_t)(encoder->cells[cell].below + (value >= encoder->cells[cell].threshold));
    }
}

void linear_encode(const float *linear, size_t count, uint8_t *encoded)
{
    for (size_t i = 0; i < count; i++) {
        float value = linear[i] > 0.0f ? linear[i] : 0.0f; /* false for NaN */
        value = value < 1.0f ? value : 1.0f;
        encoded[i] = (uint8_t)(255.0 * (double)value + 0.5);
    }
}
