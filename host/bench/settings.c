#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Appends the point, all of whose options but these have been told. */
static void append(struct bench *bench, const struct bench_point *knob)
{
    struct bench_point *point = &bench->points[bench->count++];
    *point = *knob;
    strcat(point->label, point->plan.fast ? ", fast" : "");
    strcat(point->options, point->plan.fast                ? " --fast"
                           : point->backend == BACKEND_CPU ? " --backend cpu"
                                                           : "");
}

/* Appends the point, whose picture has a max_error, with that of this text. */
static void append_max_error(struct bench *bench, struct bench_point *knob, const char *text)
{
    knob->picture.max_error = strtod(text, NULL);
    snprintf(knob->label, sizeof knob->label, "max error %s", text);
    snprintf(knob->options, sizeof knob->options, "--max-error %s --max-bounces %u", text,
             knob->picture.max_bounces);
    append(bench, knob);
}

/* Appends the point with *value, which is part of its picture, set to n. */
static void append_count(struct bench *bench, struct bench_point *knob, unsigned *value, unsigned n,
                         const char *noun, const char *option)
{
    *value = n;
    snprintf(knob->label, sizeof knob->label, "%u %s%s", n, noun, n == 1 ? "" : "s");
    snprintf(knob->options, sizeof knob->options, "%s %u", option, n);
    append(bench, knob);
}

/* The knobs that trade rays for error; those of pixel samples in exact mode alone. */
static void append_knobs(struct bench *bench, bool fast)
{
    const bool quick = bench->quick;
    struct bench_point knob = {.backend = bench->context ? BACKEND_VULKAN : BACKEND_CPU,
                               .plan.fast = fast,
                               .picture = bench->picture};
    struct picture_settings *picture = &knob.picture;
    if (bench->has_secondary_rays) {
        knob.family = FAMILY_MAX_ERROR;
        picture->has_max_error = true;
        picture->max_bounces = bench->deepest;
        for (int digits = 1; digits <= (quick ? 4 : 6); ++digits)
            append_max_error(bench, &knob, (char[]){'1', 'e', '-', (char)('0' + digits), '\0'});
        append_max_error(bench, &knob, "0");
        *picture = bench->picture;
        knob.family = FAMILY_BOUNCES;
        for (unsigned n = 0; n <= 16 && n <= bench->deepest; n += n < 8 ? 1 : 2)
            if (!quick || (n & (n - 1)) == 0)
                append_count(bench, &knob, &picture->max_bounces, n, "bounce", "--max-bounces");
        *picture = bench->picture;
    }
    knob.family = FAMILY_LIGHT_SAMPLES;
    for (unsigned n = 1; n <= 1024 && bench->has_quad_lights; n *= quick ? 4 : 2)
        append_count(bench, &knob, &picture->light_samples, n, "light sample", "--light-samples");
    *picture = bench->picture;
    knob.family = FAMILY_SAMPLES;
    for (unsigned n = 1; n <= 1024 && !fast; n *= quick ? 4 : 2)
        append_count(bench, &knob, &picture->samples, n, "sample", "--samples");
}

void bench_settings(struct bench *bench)
{
    const struct vulkan_context *context = bench->context;
    const bool quick = bench->quick;
    for (int i = context ? 0 : DEVICE_MODES; i < (quick ? QUICK_MODES : ALL_MODES); ++i)
        if (i >= DEVICE_MODES || modes[i].plan.precision == PRECISION_FLOAT || context->has_float64) {
            struct bench_point *point = &bench->points[bench->count++];
            *point = modes[i];
            point->picture = bench->picture;
        }
    append_knobs(bench, false);
    if (context && !quick)
        append_knobs(bench, true);
}
