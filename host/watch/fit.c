#include "watch/fit.h"

#include <string.h>

/* a b / c, rounded to nearest, at least 1. */
static unsigned scale(unsigned a, unsigned b, unsigned c)
{
    unsigned scaled = (unsigned)(((unsigned long long)a * b + c / 2) / c);
    return scaled > 0 ? scaled : 1;
}

struct fit fit_picture(const struct rgba_picture *picture, unsigned width, unsigned height)
{
    if (width == 0 || height == 0)
        return (struct fit){0};
    struct fit fit = {0, 0, width, height};
    if ((unsigned long long)width * picture->height <= (unsigned long long)height * picture->width)
        fit.height = scale(picture->height, width, picture->width);
    else
        fit.width = scale(picture->width, height, picture->height);
    fit.x = (width - fit.width) / 2;
    fit.y = (height - fit.height) / 2;
    return fit;
}

/* The picture's pixels that fall on pixel i of count: those from *first to before *end, at least one. */
static void find_sources(unsigned i, unsigned count, unsigned source_count, unsigned *first, unsigned *end)
{
    *first = (unsigned)((unsigned long long)i * source_count / count);
    *end = (unsigned)((unsigned long long)(i + 1) * source_count / count);
    if (*end <= *first)
        *end = *first + 1;
}

static void draw_pixel(const unsigned char rgb[3], bool blue_first, unsigned char *out)
{
    out[0] = rgb[blue_first ? 2 : 0];
    out[1] = rgb[1];
    out[2] = rgb[blue_first ? 0 : 2];
    out[3] = 255;
}

/* A row of at least as many pixels as the picture has: pixel x takes the source pixel x source_count / count.
 */
static void draw_enlarged_row(const unsigned char *in, unsigned source_count, unsigned count, bool blue_first,
                              unsigned char *out)
{
    unsigned long long remainder = 0;
    for (unsigned x = 0; x < count; ++x, out += 4) {
        draw_pixel(in, blue_first, out);
        remainder += source_count;
        if (remainder >= count) {
            remainder -= count;
            in += 4;
        }
    }
}

/* The mean of a block of the picture: count pixels from in on, in so many rows. */
static void find_mean(const unsigned char *in, unsigned count, unsigned rows, size_t row_bytes,
                      unsigned char mean[3])
{
    unsigned long long sum[3] = {0}, pixels = (unsigned long long)count * rows;
    for (unsigned row = 0; row < rows; ++row)
        for (unsigned i = 0; i < count; ++i)
            for (size_t channel = 0; channel < 3; ++channel)
                sum[channel] += in[row * row_bytes + 4 * (size_t)i + channel];
    for (size_t channel = 0; channel < 3; ++channel)
        mean[channel] = (unsigned char)((sum[channel] + pixels / 2) / pixels);
}

static void draw_row(const struct rgba_picture *picture, const struct fit *fit, unsigned y, bool blue_first,
                     unsigned char *out)
{
    const size_t row_bytes = 4 * (size_t)picture->width;
    unsigned first_row, end_row, first, end;
    find_sources(y, fit->height, picture->height, &first_row, &end_row);
    const unsigned char *in = picture->rgba + first_row * row_bytes;
    if (end_row - first_row == 1 && fit->width >= picture->width) {
        draw_enlarged_row(in, picture->width, fit->width, blue_first, out);
        return;
    }
    for (unsigned x = 0; x < fit->width; ++x, out += 4) {
        unsigned char mean[3];
        find_sources(x, fit->width, picture->width, &first, &end);
        find_mean(in + 4 * (size_t)first, end - first, end_row - first_row, row_bytes, mean);
        draw_pixel(mean, blue_first, out);
    }
}

static void draw_black(size_t count, unsigned char *out)
{
    for (; count > 0; --count, out += 4)
        memcpy(out, (const unsigned char[]){0, 0, 0, 255}, 4);
}

void fit_draw(const struct rgba_picture *picture, unsigned width, unsigned height, bool blue_first,
              unsigned char *pixels)
{
    struct fit fit = fit_picture(picture, width, height);
    unsigned right = width - fit.x - fit.width, below = height - fit.y - fit.height;
    draw_black((size_t)fit.y * width, pixels);
    for (unsigned y = 0; y < fit.height; ++y) {
        unsigned char *row = pixels + 4 * (size_t)(fit.y + y) * width;
        draw_black(fit.x, row);
        draw_row(picture, &fit, y, blue_first, row + 4 * (size_t)fit.x);
        draw_black(right, row + 4 * (size_t)(fit.x + fit.width));
    }
    draw_black((size_t)below * width, pixels + 4 * (size_t)(height - below) * width);
}
