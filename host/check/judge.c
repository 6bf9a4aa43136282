#include "check/judge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/statistics.h"
#include "check/heatmap.h"

static const double relative_floor = 1e-3;

/* The largest over the channels of |float - exact| / max(|exact|, 1e-3), and of error / bound: above 1, the
 * analysis does not explain the error. */
struct errors {
    double relative, share_of_bound;
};

static struct errors find_errors(const float *rgb, const struct reference_explanation *exact)
{
    struct errors worst = {0, 0};
    for (int c = 0; c < 3; ++c) {
        double error = fabs((double)rgb[c] - exact->rgb[c]);
        double relative = error / fmax(fabs(exact->rgb[c]), relative_floor);
        double share = error == 0 ? 0 : error / exact->bound[c];
        worst.relative = fmax(worst.relative, isnan(relative) ? INFINITY : relative);
        worst.share_of_bound = fmax(worst.share_of_bound, isnan(share) ? INFINITY : share);
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
    double *relative_errors = calloc(pixels, sizeof *relative_errors);
    *judgement = (struct judgement){0};
    if (!relative_errors) {
        log_error("no memory for the errors of %zu pixels", pixels);
        return STATUS_UNABLE;
    }
    for (size_t i = 0; i < pixels; ++i) {
        const unsigned x = (unsigned)(i % image->width), y = (unsigned)(i / image->width);
        const bool same = signatures[i] == explanations[i].signature, close = explanations[i].margin < 1;
        const struct errors errors = find_errors(image->rgb + 3 * i, &explanations[i]);
        judgement->other_signature += !same;
        judgement->close_decisions += close;
        if (!close && (!same || errors.share_of_bound > 1) && judgement->unexplained++ == 0) {
            judgement->unexplained_x = x;
            judgement->unexplained_y = y;
        }
        if (!same)
            continue;
        if (!close)
            judgement->worst_share = fmax(judgement->worst_share, errors.share_of_bound);
        if (errors.relative > judgement->max) {
            judgement->max = errors.relative;
            judgement->max_x = x;
            judgement->max_y = y;
        }
        relative_errors[count++] = errors.relative;
    }
    sort_doubles(relative_errors, count);
    judgement->median = quantile(relative_errors, count, 0.5);
    judgement->percentile_99 = quantile(relative_errors, count, 0.99);
    judgement->percentile_99_99 = quantile(relative_errors, count, 0.9999);
    free(relative_errors);
    return judgement->unexplained ? STATUS_DIFFERS : STATUS_DONE;
}

void judgement_print(const struct judgement *judgement, const char *scene, const char *precision,
                     size_t allowed)
{
    printf(
        "%s: against %s: relative error median %.2g, 99 %% %.2g, 99.99 %% %.2g, max %.2g @ (%u, %u); "
        "at most %.2g of the bound; %zu pixels with another signature, %zu near a decision, %zu unexplained",
        scene, precision, judgement->median, judgement->percentile_99, judgement->percentile_99_99,
        judgement->max, judgement->max_x, judgement->max_y, judgement->worst_share,
        judgement->other_signature, judgement->close_decisions, judgement->unexplained);
    if (judgement->unexplained > 0)
        printf(" @ (%u, %u)%s", judgement->unexplained_x, judgement->unexplained_y,
               judgement->unexplained <= allowed ? "" : "  UNEXPLAINED");
    putchar('\n');
}

json_t *judgement_json(const struct judgement *judgement, const char *scene, const char *precision,
                       size_t allowed)
{
    return json_pack("{s:s, s:s, s:b, s:{s:o, s:o, s:o, s:o}, s:o, s:I, s:I, s:I}", "scene", scene, "against",
                     precision, "explained", judgement->unexplained <= allowed, "relative_error", "median",
                     json_real_or_null(judgement->median), "percentile_99",
                     json_real_or_null(judgement->percentile_99), "percentile_99_99",
                     json_real_or_null(judgement->percentile_99_99), "max", json_real_or_null(judgement->max),
                     "largest_share_of_bound", json_real_or_null(judgement->worst_share),
                     "other_signature_pixels", (json_int_t)judgement->other_signature,
                     "close_decision_pixels", (json_int_t)judgement->close_decisions, "unexplained_pixels",
                     (json_int_t)judgement->unexplained);
}

struct judged_picture {
    const struct image *image;
    const struct reference_explanation *explanations;
};

static enum status encode_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct judged_picture *picture = context;
    size_t width = picture->image->width;
    for (size_t x = 0; x < width; ++x) {
        size_t i = y * width + x;
        const struct reference_explanation *exact = &picture->explanations[i];
        viridis(1 + log2(find_errors(picture->image->rgb + 3 * i, exact).relative) / 24, rgb + 3 * x);
        viridis(1 - log2(exact->margin) / 24, rgb + 3 * (width + x));
    }
    return STATUS_DONE;
}

enum status judgement_heatmap(const struct image *image, const struct reference_explanation *explanations,
                              const char *path)
{
    return heatmap_png(
        2 * image->width, image->height,
        "left: relative error, violet 2^-24 to yellow 1; right: margin of the closest decision, "
        "violet 2^24 to yellow 1 and less; both logarithmic",
        encode_row, &(struct judged_picture){image, explanations}, path);
}
