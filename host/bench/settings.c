#include <stdio.h>
#include <stdlib.h>

#include "bench/measure.h"

/* What is measured of the scene as it is: on a device first, on the CPU in any bench, and in a full one. */
enum { DEVICE_MODES = 3, QUICK_MODES = 6, ALL_MODES = 7 };
static const struct bench_point modes[ALL_MODES] = {
    {.label = "exact"},
    {.plan.fast = true, .label = "fast", .options = "--fast"},
    {.plan.precision = PRECISION_DOUBLE, .label = "double", .options = "--precision double"},
    {FAMILY_CPU, BACKEND_CPU, .label = "CPU", .options = "--backend cpu"},
    {FAMILY_CPU, BACKEND_CPU, .plan.threads = 1, .label = "CPU, 1 thread",
     .options = "--backend cpu --threads 1"},
    {FAMILY_CPU, BACKEND_CPU, .plan.precision = PRECISION_DOUBLE, .label = "CPU, double",
     .options = "--backend cpu --precision double"},
    {FAMILY_CPU, BACKEND_CPU, .plan.precision = PRECISION_DOUBLE, .plan.threads = 1,
     .label = "CPU, double, 1 thread", .options = "--backend cpu --precision double --threads 1"},
};

/* The next point of the bench in the making. */
struct knob {
    struct bench *bench;
    struct bench_point point;
    const char *label_end, *options_end;
};

static void append(const struct knob *knob)
{
    if (knob->bench->count < BENCH_MAX_SETTINGS)
        knob->bench->points[knob->bench->count++] = knob->point;
}

/* Appends the point, whose picture has a max_error, of this text. */
static void append_max_error(struct knob *knob, const char *text)
{
    struct bench_point *point = &knob->point;
    point->picture.max_error = strtod(text, NULL);
    snprintf(point->label, sizeof point->label, "max error %s%s", text, knob->label_end);
    snprintf(point->options, sizeof point->options, "--max-error %s --max-bounces %u%s", text,
             point->picture.max_bounces, knob->options_end);
    append(knob);
}

/* Appends the point with *value, which is part of its picture, set to n. */
static void append_count(struct knob *knob, unsigned *value, unsigned n, const char *noun, const char *option)
{
    struct bench_point *point = &knob->point;
    *value = n;
    snprintf(point->label, sizeof point->label, "%u %s%s%s", n, noun, n == 1 ? "" : "s", knob->label_end);
    snprintf(point->options, sizeof point->options, "%s %u%s", option, n, knob->options_end);
    append(knob);
}

/* The knobs that trade rays for error. */
static void append_knobs(struct knob *knob)
{
    const struct bench *bench = knob->bench;
    const bool quick = bench->options->quick;
    struct picture_settings *picture = &knob->point.picture;
    if (bench->has_secondary_rays) {
        knob->point.family = FAMILY_MAX_ERROR;
        picture->has_max_error = true;
        picture->max_bounces = bench->deepest;
        for (int digits = 1; digits <= (quick ? 4 : 6); ++digits)
            append_max_error(knob, (char[]){'1', 'e', '-', (char)('0' + digits), '\0'});
        append_max_error(knob, "0");
        *picture = bench->picture;
        knob->point.family = FAMILY_BOUNCES;
        for (unsigned n = 0; n <= 16 && n <= bench->deepest; n += n < 8 ? 1 : 2)
            if (!quick || (n & (n - 1)) == 0)
                append_count(knob, &picture->max_bounces, n, "bounce", "--max-bounces");
    }
    *picture = bench->picture;
    knob->point.family = FAMILY_LIGHT_SAMPLES;
    for (unsigned n = 1; n <= 1024 && bench->has_quad_lights; n *= quick ? 4 : 2)
        append_count(knob, &picture->light_samples, n, "light sample", "--light-samples");
    *picture = bench->picture;
}

void bench_settings(struct bench *bench)
{
    const bool on_device = bench->options->context != NULL, quick = bench->options->quick;
    struct knob knob = {.bench = bench, .label_end = "", .options_end = on_device ? "" : " --backend cpu"};
    for (int i = on_device ? 0 : DEVICE_MODES; i < (quick ? QUICK_MODES : ALL_MODES); ++i) {
        knob.point = modes[i];
        knob.point.picture = bench->picture;
        if (i >= DEVICE_MODES || knob.point.plan.precision == PRECISION_FLOAT ||
            bench->options->context->has_float64)
            append(&knob);
    }
    knob.point =
        (struct bench_point){.backend = on_device ? BACKEND_VULKAN : BACKEND_CPU, .picture = bench->picture};
    append_knobs(&knob);
    if (on_device && !quick) {
        knob.point.plan.fast = true;
        knob.label_end = ", fast";
        knob.options_end = " --fast";
        append_knobs(&knob);
        knob.point.plan.fast = false;
        knob.label_end = knob.options_end = "";
    }
    knob.point.family = FAMILY_SAMPLES;
    for (unsigned n = 1; n <= 1024; n *= quick ? 4 : 2)
        append_count(&knob, &knob.point.picture.samples, n, "sample", "--samples");
}
