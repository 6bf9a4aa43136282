#include "check/compare.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "image/formats.h"
#include "image/viridis.h"

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static double larger_magnitude(double a, double b)
{
    return fmax(fabs(a), fabs(b));
}

/* |a - b|; see struct comparison for what is not finite. */
static double channel_error(double a, double b)
{
    if (isnan(a) && isnan(b))
        return 0.0;
    if (!isfinite(a) || !isfinite(b))
        return same_bits(a, b) ? 0.0 : INFINITY;
    return fabs(a - b);
}

static bool agree(double a, double b, const struct tolerance *tolerance)
{
    if (!tolerance || same_bits(a, b))
        return same_bits(a, b);
    if (isnan(a) && isnan(b))
        return true;
    double bound = tolerance->absolute + tolerance->relative * larger_magnitude(a, b);
    return isfinite(a) && isfinite(b) && channel_error(a, b) <= bound;
}

/* The largest error so far of one kind, and where. */
struct worst {
    bool any;
    double error;
    unsigned x, y, channel;
};

static void note(struct worst *worst, double error, unsigned x, unsigned y, unsigned channel)
{
    if (!worst->any || error > worst->error)
        *worst = (struct worst){true, error, x, y, channel};
}

static bool same_size(const struct image *a, const struct image *b)
{
    if (a->width == b->width && a->height == b->height)
        return true;
    log_error("cannot compare a picture of %ux%u pixels with one of %ux%u", a->width, a->height, b->width,
              b->height);
    return false;
}

/* In the best precision that the picture has. */
static double value_at(const struct image *image, size_t index)
{
    return image->rgb64 ? image->rgb64[index] : (double)image->rgb[index];
}

enum status image_compare(const struct image *a, const struct image *b, const struct tolerance *tolerance,
                          struct comparison *comparison)
{
    *comparison = (struct comparison){0};
    if (!same_size(a, b))
        return STATUS_REFUSED;

    struct worst disagreeing = {0}, unequal = {0};
    for (unsigned y = 0; y < a->height; y++) {
        size_t row = (size_t)y * a->width * 3;
        for (unsigned x = 0; x < a->width; x++) {
            bool pixel_same = true, pixel_agrees = true;
            for (unsigned channel = 0; channel < 3; channel++) {
                double value_a = value_at(a, row + (size_t)x * 3 + channel);
                double value_b = value_at(b, row + (size_t)x * 3 + channel);
                if (same_bits(value_a, value_b))
                    continue;
                pixel_same = false;
                double error = channel_error(value_a, value_b);
                note(&unequal, error, x, y, channel);
                if (agree(value_a, value_b, tolerance))
                    continue;
                pixel_agrees = false;
                note(&disagreeing, error, x, y, channel);
            }
            comparison->bit_differing += !pixel_same;
            comparison->differing += !pixel_agrees;
        }
    }

    const struct worst *worst = disagreeing.any ? &disagreeing : &unequal;
    comparison->max_error = worst->error;
    comparison->x = worst->x;
    comparison->y = worst->y;
    comparison->channel = worst->channel;
    return comparison->differing > 0 ? STATUS_DIFFERS : STATUS_DONE;
}

void heatmap_color(const float *a, const float *b, uint8_t *rgb)
{
    if (memcmp(a, b, 3 * sizeof(float)) == 0) {
        memset(rgb, 0, 3);
        return;
    }
    double relative_error = 0.0;
    for (int c = 0; c < 3; c++) {
        if (same_bits(a[c], b[c]))
            continue;
        if (!isfinite(a[c]) || !isfinite(b[c])) {
            memset(rgb, 255, 3);
            return;
        }
        double magnitude = larger_magnitude(a[c], b[c]);
        relative_error = fmax(relative_error, magnitude > 0.0 ? channel_error(a[c], b[c]) / magnitude : 0.0);
    }
    double level = relative_error > 0.0 ? 1.0 + log2(relative_error) / 24.0 : 0.0;
    viridis(level, rgb);
}

struct pair {
    const struct image *a, *b;
};

static void encode_heat_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct pair *pair = context;
    size_t start = (size_t)y * pair->a->width * 3;
    for (size_t x = 0; x < pair->a->width; x++)
        heatmap_color(pair->a->rgb + start + x * 3, pair->b->rgb + start + x * 3, rgb + x * 3);
}

enum status heatmap_write(const struct image *a, const struct image *b, const char *path)
{
    if (!same_size(a, b))
        return STATUS_REFUSED;
    const struct pair pair = {a, b};
    const struct png_text texts[] = {
        {"Software", "vkwhitted"},
        {"Description",
         "largest relative error of a pixel's channels, logarithmic: violet 2^-24, blue 2^-18, "
         "teal 2^-12, green 2^-6, yellow 1; black: same bits; white: not finite"},
    };
    const struct png_source source = {
        .width = a->width,
        .height = a->height,
        .transfer = TRANSFER_SRGB,
        .texts = texts,
        .text_count = (int)(sizeof texts / sizeof texts[0]),
        .encode_row = encode_heat_row,
        .context = &pair,
    };
    return png_write(&source, path);
}
