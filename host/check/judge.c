#include "check/judge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/statistics.h"

static const double relative_floor = 1e-3, tight = 1e-2;

/* A pixel's errors, the largest over its channels. */
struct pixel_error {
    double relative;       /* |float - exact| / max(|exact|, 1e-3) */
    double share_of_bound; /* |float - exact| / bound: above 1 the analysis does not explain it */
};

/* What is not a number, on either side, is infinitely wrong. */
static struct pixel_error judge_pixel(const float *rgb, const struct reference_explanation *exact)
{
    struct pixel_error worst = {0, 0};
    for (int c = 0; c < 3; ++c) {
        double error = fabs((double)rgb[c] - exact->rgb[c]);
        double relative = error / fmax(fabs(exact->rgb[c]), relative_floor);
        double share = error == 0 ? 0 : error / exact->bound[c];
        worst.relative = fmax(worst.relative, isnan(relative) ? INFINITY : relative);
        worst.share_of_bound = fmax(worst.share_of_bound, isnan(share) ? INFINITY : share);
    }
    return worst;
}

static bool is_tight(const struct reference_explanation *exact)
{
    return exact->bound[0] <= tight && exact->bound[1] <= tight && exact->bound[2] <= tight;
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
        const struct reference_explanation *exact = &explanations[i];
        const struct pixel_error error = judge_pixel(image->rgb + 3 * i, exact);
        const bool same = signatures[i] == exact->signature;
        judgement->other_signature += !same;
        if ((error.share_of_bound > 1 || (!same && !(exact->margin < 1))) && judgement->unexplained++ == 0) {
            judgement->unexplained_x = x;
            judgement->unexplained_y = y;
        }
        if (is_tight(exact)) {
            ++judgement->tight;
            judgement->worst_share = fmax(judgement->worst_share, error.share_of_bound);
        } else {
            ++judgement->wide[exact->cause];
        }
        if (!same)
            continue;
        if (error.relative > judgement->max) {
            judgement->max = error.relative;
            judgement->max_x = x;
            judgement->max_y = y;
        }
        relative_errors[count++] = error.relative;
    }
    sort_doubles(relative_errors, count);
    judgement->median = sorted_quantile(relative_errors, count, 0.5);
    judgement->percentile_99 = sorted_quantile(relative_errors, count, 0.99);
    judgement->percentile_99_99 = sorted_quantile(relative_errors, count, 0.9999);
    free(relative_errors);
    return judgement->unexplained ? STATUS_DIFFERS : STATUS_DONE;
}

void judgement_print(const struct judgement *judgement, const char *scene, const char *precision,
                     size_t allowed)
{
    static const char *const causes[CAUSE_COUNT] = {
        [CAUSE_ROUNDING] = "rounding",           [CAUSE_HIT] = "hit or miss", [CAUSE_SHADOW] = "shadow",
        [CAUSE_REFLECTION] = "total reflection", [CAUSE_UNKNOWN] = "unknown",
    };
    printf("%s: against %s: relative error median %.2g, 99 %% %.2g, 99.99 %% %.2g, max %.2g @ (%u, %u); "
           "%zu pixels with a bound of 1e-2 or less, at most %.2g of it; wider by",
           scene, precision, judgement->median, judgement->percentile_99, judgement->percentile_99_99,
           judgement->max, judgement->max_x, judgement->max_y, judgement->tight, judgement->worst_share);
    for (int i = 0; i < CAUSE_COUNT; ++i)
        printf("%s %s %zu", i > 0 ? "," : "", causes[i], judgement->wide[i]);
    printf("; %zu with another signature, %zu unexplained", judgement->other_signature,
           judgement->unexplained);
    if (judgement->unexplained > 0)
        printf(" @ (%u, %u)%s", judgement->unexplained_x, judgement->unexplained_y,
               judgement->unexplained <= allowed ? "" : "  UNEXPLAINED");
    putchar('\n');
}

json_t *judgement_json(const struct judgement *judgement, const char *scene, const char *precision,
                       size_t allowed)
{
    const size_t *wide = judgement->wide;
    json_t *wide_pixels =
        json_pack("{s:I, s:I, s:I, s:I, s:I}", "rounding", (json_int_t)wide[CAUSE_ROUNDING], "hit_or_miss",
                  (json_int_t)wide[CAUSE_HIT], "shadow", (json_int_t)wide[CAUSE_SHADOW], "total_reflection",
                  (json_int_t)wide[CAUSE_REFLECTION], "unknown", (json_int_t)wide[CAUSE_UNKNOWN]);
    return json_pack("{s:s, s:s, s:b, s:{s:o, s:o, s:o, s:o}, s:I, s:o, s:o, s:I, s:I}", "scene", scene,
                     "against", precision, "explained", judgement->unexplained <= allowed, "relative_error",
                     "median", json_real_or_null(judgement->median), "percentile_99",
                     json_real_or_null(judgement->percentile_99), "percentile_99_99",
                     json_real_or_null(judgement->percentile_99_99), "max", json_real_or_null(judgement->max),
                     "tight_pixels", (json_int_t)judgement->tight, "largest_share_of_bound",
                     json_real_or_null(judgement->worst_share), "wide_pixels", wide_pixels,
                     "other_signature_pixels", (json_int_t)judgement->other_signature, "unexplained_pixels",
                     (json_int_t)judgement->unexplained);
}

/* Left the error, right the bound on it, relative to what is exact. */
static void color(const void *context, unsigned x, unsigned y, uint8_t rgb[static 3])
{
    const struct judged_picture *picture = context;
    const unsigned width = picture->image->width;
    const size_t i = (size_t)y * width + x % width;
    const struct reference_explanation *exact = &picture->explanations[i];
    double relative = 0;
    if (x < width)
        relative = judge_pixel(picture->image->rgb + 3 * i, exact).relative;
    for (int c = 0; c < 3 && x >= width; ++c)
        relative = fmax(relative, exact->bound[c] / fmax(fabs(exact->rgb[c]), relative_floor));
    error_color(relative, rgb);
}

struct heatmap judgement_heatmap(const struct judged_picture *picture)
{
    return (struct heatmap){
        .width = 2 * picture->image->width,
        .height = picture->image->height,
        .description =
            "left: relative error, right: relative bound on it; violet 2^-24 to yellow 1, logarithmic",
        .color = color,
        .context = picture,
    };
}
