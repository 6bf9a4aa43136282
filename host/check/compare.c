#include "check/compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* |a - b| of two values that are not the same bits; see struct comparison for what is not finite. */
static double channel_error(double a, double b)
{
    if (isnan(a) && isnan(b))
        return 0.0;
    return isfinite(a) && isfinite(b) ? fabs(a - b) : INFINITY;
}

/* Whether the tolerance covers an error between two values. */
static bool covers(const struct tolerance *tolerance, double a, double b, double error)
{
    return tolerance &&
           (error == 0 ||
            (isfinite(error) && error <= tolerance->absolute + tolerance->relative * fmax(fabs(a), fabs(b))));
}

/* The largest error so far of one kind, below 0 where there is none, and of which channel value. */
struct worst {
    double error;
    size_t index;
};

static void note(struct worst *worst, double error, size_t index)
{
    if (error > worst->error)
        *worst = (struct worst){error, index};
}

static double value_at(const struct image *image, size_t index)
{
    return image->rgb64 ? image->rgb64[index] : (double)image->rgb[index];
}

struct comparison image_compare(const struct image *a, const struct image *b,
                                const struct tolerance *tolerance)
{
    struct comparison comparison = {.width = a->width, .height = a->height};
    struct worst disagreeing = {.error = -1}, unequal = {.error = -1};
    const size_t pixels = (size_t)a->width * a->height;
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        bool pixel_same = true, pixel_agrees = true;
        for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            double value_a = value_at(a, i), value_b = value_at(b, i);
            if (same_bits(value_a, value_b))
                continue;
            pixel_same = false;
            double error = channel_error(value_a, value_b);
            note(&unequal, error, i);
            if (covers(tolerance, value_a, value_b, error))
                continue;
            pixel_agrees = false;
            note(&disagreeing, error, i);
        }
        comparison.bit_differing += !pixel_same;
        if (!pixel_agrees && comparison.differing++ == 0) {
            comparison.first_x = (unsigned)(pixel % a->width);
            comparison.first_y = (unsigned)(pixel / a->width);
        }
    }
    const struct worst *worst = comparison.differing > 0 ? &disagreeing : &unequal;
    comparison.max_error = fmax(worst->error, 0);
    comparison.x = (unsigned)(worst->index / 3 % a->width);
    comparison.y = (unsigned)(worst->index / 3 / a->width);
    comparison.channel = (unsigned)(worst->index % 3);
    return comparison;
}

static const char *const channels[] = {"r", "g", "b"};

void comparison_print(const struct comparison *comparison, const char *scene, size_t allowed)
{
    printf("%s: %zu of %zu pixels differ, max error %.9g @ (%u, %u, %s)%s\n", scene, comparison->differing,
           (size_t)comparison->width * comparison->height, comparison->max_error, comparison->x,
           comparison->y, channels[comparison->channel], comparison->differing <= allowed ? "" : "  DIFFERS");
}

json_t *comparison_json(const struct comparison *comparison, const char *scene, size_t allowed)
{
    return json_pack("{s:s, s:b, s:i, s:i, s:I, s:I, s:o, s:{s:i, s:i, s:s}}", "scene", scene, "agrees",
                     comparison->differing <= allowed, "width", (int)comparison->width, "height",
                     (int)comparison->height, "differing_pixels", (json_int_t)comparison->differing,
                     "bit_differing_pixels", (json_int_t)comparison->bit_differing, "max_error",
                     json_real_or_null(comparison->max_error), "at", "x", (int)comparison->x, "y",
                     (int)comparison->y, "channel", channels[comparison->channel]);
}
