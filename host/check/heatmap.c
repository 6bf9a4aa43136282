#include "check/heatmap.h"

#include <math.h>
#include <string.h>

#include "image/formats.h"

void error_color(double relative_error, uint8_t *rgb)
{
    static const double ramp[5][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const double level = fmin(fmax(1.0 + log2(relative_error) / 24.0, 0.0), 1.0);
    int quarter = level < 1.0 ? (int)(level * 4.0) : 3;
    double fraction = level * 4.0 - quarter;
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)lround(ramp[quarter][c] + fraction * (ramp[quarter + 1][c] - ramp[quarter][c]));
}

void heatmap_color(const float *a, const float *b, uint8_t *rgb)
{
    double relative_error = 0.0;
    if (memcmp(a, b, 3 * sizeof *a) == 0) {
        memset(rgb, 0, 3);
        return;
    }
    for (int c = 0; c < 3; c++) {
        if (memcmp(&a[c], &b[c], sizeof a[c]) == 0)
            continue;
        if (!isfinite(a[c]) || !isfinite(b[c])) {
            memset(rgb, 255, 3);
            return;
        }
        double magnitude = fmax(fabs((double)a[c]), fabs((double)b[c]));
        if (magnitude > 0.0)
            relative_error = fmax(relative_error, fabs((double)a[c] - (double)b[c]) / magnitude);
    }
    error_color(relative_error, rgb);
}

static void color_difference(const void *context, unsigned x, unsigned y, uint8_t rgb[static 3])
{
    const struct image_pair *pair = context;
    const size_t first = 3 * ((size_t)y * pair->a->width + x);
    heatmap_color(pair->a->rgb + first, pair->b->rgb + first, rgb);
}

struct heatmap difference_heatmap(const struct image_pair *pair)
{
    return (struct heatmap){
        .width = pair->a->width,
        .height = pair->a->height,
        .description = "largest relative error of a pixel's channels, logarithmic: violet 2^-24, blue 2^-18, "
                       "teal 2^-12, green 2^-6, yellow 1; black: same bits; white: not finite",
        .color = color_difference,
        .context = pair,
    };
}

static enum status encode_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct heatmap *heatmap = context;
    for (unsigned x = 0; x < heatmap->width; ++x)
        heatmap->color(heatmap->context, x, y, rgb + 3 * (size_t)x);
    return STATUS_DONE;
}

enum status heatmap_write(const struct heatmap *heatmap, const char *path)
{
    const struct png_text text = {"Description", heatmap->description};
    const struct png_source source = {
        .width = heatmap->width,
        .height = heatmap->height,
        .transfer = TRANSFER_SRGB,
        .texts = &text,
        .text_count = 1,
        .encode_row = encode_row,
        .context = heatmap,
    };
    return png_write(&source, path);
}
