#include "check/verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Relative errors are those of values of this size at least. */
static const double relative_floor = 1e-3;

static const double noticed = 1e-3, slight = 1e-4; /* relative errors */
static const double near_edge = 1000;              /* margin, in float's roundings */

static double distance_from(struct value_range range, double exact)
{
    if (isnan(range.low) || (range.low == range.high && isinf(range.low)))
        return INFINITY;
    return exact < (double)range.low ? (double)range.low - exact : fmax(exact - (double)range.high, 0);
}

struct pixel_verdict {
    enum verdict verdict;
    double error, relative; /* the largest, and the largest by its value */
    unsigned channel;       /* of the former */
};

static struct pixel_verdict find_verdict(const struct value_range *rgb,
                                         const struct reference_explanation *exact,
                                         const struct tolerance *tolerance)
{
    struct pixel_verdict pixel = {VERDICT_RIGHT, 0, 0, 0};
    bool wrong = false;
    for (unsigned c = 0; c < 3; ++c) {
        const double size = fabs(exact->rgb[c]), error = distance_from(rgb[c], exact->rgb[c]);
        wrong |= !(error <= exact->bound[c] + tolerance->absolute + tolerance->relative * size);
        pixel.relative = fmax(pixel.relative, error / fmax(size, relative_floor));
        if (error > pixel.error) {
            pixel.error = error;
            pixel.channel = c;
        }
    }
    if (wrong)
        pixel.verdict = pixel.relative < slight     ? VERDICT_SLIGHTLY_OFF
                        : exact->margin < near_edge ? VERDICT_EDGE
                                                    : VERDICT_WRONG;
    else if (exact->margin < 1 && pixel.relative >= noticed)
        pixel.verdict = VERDICT_NEAR_DECISION;
    return pixel;
}

size_t verdicts_wrong(const struct verdicts *verdicts)
{
    return verdicts->pixels[VERDICT_SLIGHTLY_OFF] + verdicts->pixels[VERDICT_EDGE] +
           verdicts->pixels[VERDICT_WRONG];
}

enum status verdicts_find(const struct read_image *picture, const struct reference_explanation *explanations,
                          const struct tolerance *tolerance, struct verdicts *verdicts)
{
    *verdicts = (struct verdicts){.error = -1};
    for (size_t i = 0; i < (size_t)picture->width * picture->height; ++i) {
        const struct reference_explanation *exact = &explanations[i];
        const struct pixel_verdict pixel = find_verdict(picture->rgb + 3 * i, exact, tolerance);
        const bool wrong = pixel.verdict > VERDICT_NEAR_DECISION;
        ++verdicts->pixels[pixel.verdict];
        if (wrong == verdicts->any_wrong ? pixel.error > verdicts->error : wrong) {
            verdicts->any_wrong = wrong;
            verdicts->error = pixel.error;
            verdicts->x = (unsigned)(i % picture->width);
            verdicts->y = (unsigned)(i / picture->width);
            verdicts->channel = pixel.channel;
            verdicts->value = picture->rgb[3 * i + pixel.channel];
            verdicts->exact = exact->rgb[pixel.channel];
            verdicts->bound = exact->bound[pixel.channel];
            verdicts->margin = exact->margin;
        }
    }
    return verdicts->any_wrong ? STATUS_DIFFERS : STATUS_DONE;
}

static const char *const channels[] = {"r", "g", "b"};

static void print_largest(const struct verdicts *verdicts)
{
    printf("; largest error %.3g @ (%u, %u, %s): ", verdicts->error, verdicts->x, verdicts->y,
           channels[verdicts->channel]);
    if (verdicts->value.low < verdicts->value.high)
        printf("%.6g to %.6g", (double)verdicts->value.low, (double)verdicts->value.high);
    else
        printf("%.9g", (double)verdicts->value.low);
    printf(", exactly %.9g, bound %.2g, closest decision %.3g roundings away", verdicts->exact,
           verdicts->bound, verdicts->margin);
}

void verdicts_print(const struct verdicts *verdicts, const char *scene, const char *picture,
                    const char *precision, size_t allowed)
{
    const size_t *pixels = verdicts->pixels, wrong = verdicts_wrong(verdicts);
    printf("%s: %s against %s: %zu pixels right, %zu near a decision, %zu wrong", scene, picture, precision,
           pixels[VERDICT_RIGHT], pixels[VERDICT_NEAR_DECISION], wrong);
    if (wrong > 0)
        printf(" (%zu by less than 1e-4 of their value, %zu within 1000 roundings of an edge, %zu others)",
               pixels[VERDICT_SLIGHTLY_OFF], pixels[VERDICT_EDGE], pixels[VERDICT_WRONG]);
    if (verdicts->error > 0)
        print_largest(verdicts);
    puts(wrong <= allowed ? "" : "  WRONG");
}

json_t *verdicts_json(const struct verdicts *verdicts, const char *scene, const char *picture,
                      const char *precision, size_t allowed)
{
    const size_t *pixels = verdicts->pixels;
    return json_pack(
        "{s:s, s:s, s:s, s:b, s:I, s:I, s:{s:I, s:I, s:I}, s:{s:o, s:i, s:i, s:s, s:[o, o], s:o, s:o, s:o}}",
        "scene", scene, "picture", picture, "against", precision, "right",
        verdicts_wrong(verdicts) <= allowed, "right_pixels", (json_int_t)pixels[VERDICT_RIGHT],
        "near_decision_pixels", (json_int_t)pixels[VERDICT_NEAR_DECISION], "wrong_pixels", "slightly",
        (json_int_t)pixels[VERDICT_SLIGHTLY_OFF], "near_edge", (json_int_t)pixels[VERDICT_EDGE], "others",
        (json_int_t)pixels[VERDICT_WRONG], "largest_error", "error", json_real_or_null(verdicts->error), "x",
        (int)verdicts->x, "y", (int)verdicts->y, "channel", channels[verdicts->channel], "value_range",
        json_real_or_null((double)verdicts->value.low), json_real_or_null((double)verdicts->value.high),
        "exact", json_real_or_null(verdicts->exact), "bound", json_real_or_null(verdicts->bound), "margin",
        json_real_or_null(verdicts->margin));
}

static void color(const void *context, unsigned x, unsigned y, uint8_t rgb[static 3])
{
    static const uint8_t blue[3] = {40, 70, 255};
    const struct compared_picture *compared = context;
    const size_t i = (size_t)y * compared->picture->width + x;
    const struct pixel_verdict pixel =
        find_verdict(compared->picture->rgb + 3 * i, &compared->explanations[i], compared->tolerance);
    if (pixel.verdict == VERDICT_RIGHT)
        memset(rgb, 0, 3);
    else if (pixel.verdict == VERDICT_NEAR_DECISION)
        memcpy(rgb, blue, 3);
    else
        error_color(pixel.relative, rgb);
}

struct heatmap verdicts_heatmap(const struct compared_picture *compared)
{
    return (struct heatmap){
        .width = compared->picture->width,
        .height = compared->picture->height,
        .description =
            "black: right; blue: near a decision; wrong: relative error, violet 2^-24 to yellow 1, "
            "logarithmic",
        .color = color,
        .context = compared,
    };
}
