#include "check/judge.h"

#include <math.h>
#include <stdlib.h>

#include "base/statistics.h"
#include "image/formats.h"
#include "image/viridis.h"

static const double relative_floor = 1e-3;

static double relative_error(const float *rgb, const struct reference_explanation *exact)
{
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        double error = fabs((double)rgb[c] - exact->rgb[c]) / fmax(fabs(exact->rgb[c]), relative_floor);
        worst = fmax(worst, isnan(error) ? INFINITY : error);
    }
    return worst;
}

/* The largest over the channels of error / bound: above 1, the analysis does not explain the error. */
static double share_of_bound(const float *rgb, const struct reference_explanation *exact)
{
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        double error = fabs((double)rgb[c] - exact->rgb[c]);
        double share = error == 0 ? 0 : error / exact->bound[c];
        worst = fmax(worst, isnan(share) ? INFINITY : share);
    }
    return worst;
}

static double quantile(const double *sorted, size_t count, double fraction)
{
    return count == 0 ? 0 : sorted[(size_t)(fraction * (double)(count - 1))];
}

enum status judge_picture(const struct image *image, const uint32_t *signatures,
                          const struct reference_explanation *explanations, struct judgement *judgement)
{
    size_t pixels = (size_t)image->width * image->height, count = 0;
    double *errors = calloc(pixels, sizeof *errors);
    *judgement = (struct judgement){0};
    if (!errors) {
        log_error("no memory for the errors of %zu pixels", pixels);
        return STATUS_UNABLE;
    }
    for (size_t i = 0; i < pixels; ++i) {
        const struct reference_explanation *exact = &explanations[i];
        unsigned x = (unsigned)(i % image->width), y = (unsigned)(i / image->width);
        bool same = signatures[i] == exact->signature, close = exact->margin < 1;
        double error = relative_error(image->rgb + 3 * i, exact);
        judgement->other_signature += !same;
        judgement->close_decisions += close;
        double share = share_of_bound(image->rgb + 3 * i, exact);
        if (!close && same)
            judgement->worst_share = fmax(judgement->worst_share, share);
        if (!close && (!same || share > 1) && judgement->unexplained++ == 0) {
            judgement->unexplained_x = x;
            judgement->unexplained_y = y;
        }
        if (same && error > judgement->max) {
            judgement->max = error;
            judgement->max_x = x;
            judgement->max_y = y;
        }
        if (same)
            errors[count++] = error;
    }
    sort_doubles(errors, count);
    judgement->median = quantile(errors, count, 0.5);
    judgement->percentile_99 = quantile(errors, count, 0.99);
    judgement->percentile_99_99 = quantile(errors, count, 0.9999);
    free(errors);
    return judgement->unexplained ? STATUS_DIFFERS : STATUS_DONE;
}

struct judged_picture {
    const struct image *image;
    const struct reference_explanation *explanations;
};

static void encode_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct judged_picture *picture = context;
    size_t width = picture->image->width;
    for (size_t x = 0; x < width; ++x) {
        size_t i = y * width + x;
        const struct reference_explanation *exact = &picture->explanations[i];
        viridis(1 + log2(relative_error(picture->image->rgb + 3 * i, exact)) / 24, rgb + 3 * x);
        viridis(1 - log2(exact->margin) / 24, rgb + 3 * (width + x));
    }
}

enum status judgement_heatmap(const struct image *image, const struct reference_explanation *explanations,
                              const char *path)
{
    const struct judged_picture picture = {image, explanations};
    const struct png_text texts[] = {
        {"Software", "vkwhitted"},
        {"Description",
         "left: relative error, violet 2^-24 to yellow 1; right: margin of the closest decision, violet "
         "2^24 to yellow 1 and less; both logarithmic"},
    };
    return png_write(
        &(struct png_source){
            .width = 2 * image->width,
            .height = image->height,
            .transfer = TRANSFER_SRGB,
            .texts = texts,
            .text_count = (int)(sizeof texts / sizeof *texts),
            .encode_row = encode_row,
            .context = &picture,
        },
        path);
}
