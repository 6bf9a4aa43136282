#include "bench/settings.h"

#include <stdio.h>
#include <stdlib.h>

/* What is measured of the scene as it is: on a device first, on the CPU in any bench, and in a full one. */
enum { DEVICE_MODES = 3, QUICK_MODES = 6, ALL_MODES = 7 };
static const struct bench_setting modes[ALL_MODES] = {
    {.label = "exact"},
    {.fast = true, .label = "fast", .options = "--fast"},
    {.precision = PRECISION_DOUBLE, .label = "double", .options = "--precision double"},
    {FAMILY_CPU, BACKEND_CPU, .label = "CPU", .options = "--backend cpu"},
    {FAMILY_CPU, BACKEND_CPU, .threads = 1, .label = "CPU, 1 thread", .options = "--backend cpu --threads 1"},
    {FAMILY_CPU, BACKEND_CPU, PRECISION_DOUBLE, .label = "CPU, double",
     .options = "--backend cpu --precision double"},
    {FAMILY_CPU, BACKEND_CPU, PRECISION_DOUBLE, .threads = 1, .label = "CPU, double, 1 thread",
     .options = "--backend cpu --precision double --threads 1"},
};

struct list {
    struct bench_setting *settings;
    size_t count;
    struct bench_setting knob; /* the setting in the making */
    const char *label_end, *options_end;
};

static void append(struct list *list)
{
    if (list->count < BENCH_MAX_SETTINGS)
        list->settings[list->count++] = list->knob;
}

/* Appends the knob, whose picture has this max_error of this text. */
static void append_max_error(struct list *list, const char *text)
{
    struct bench_setting *knob = &list->knob;
    knob->picture.max_error = strtod(text, NULL);
    snprintf(knob->label, sizeof knob->label, "max error %s%s", text, list->label_end);
    snprintf(knob->options, sizeof knob->options, "--max-error %s --max-bounces %u%s", text,
             knob->picture.max_bounces, list->options_end);
    append(list);
}

/* Appends the knob with *value, which is part of its picture, set to n. */
static void append_count(struct list *list, unsigned *value, unsigned n, const char *noun, const char *option)
{
    struct bench_setting *knob = &list->knob;
    *value = n;
    snprintf(knob->label, sizeof knob->label, "%u %s%s%s", n, noun, n == 1 ? "" : "s", list->label_end);
    snprintf(knob->options, sizeof knob->options, "%s %u%s", option, n, list->options_end);
    append(list);
}

/* The knobs that trade rays for error. */
static void append_knobs(struct list *list, const struct bench_choice *choice)
{
    struct picture_settings *picture = &list->knob.picture;
    if (choice->has_secondary_rays) {
        list->knob.family = FAMILY_MAX_ERROR;
        picture->has_max_error = true;
        picture->max_bounces = choice->deepest;
        for (int digits = 1; digits <= (choice->quick ? 4 : 6); ++digits)
            append_max_error(list, (char[]){'1', 'e', '-', (char)('0' + digits), '\0'});
        append_max_error(list, "0");
        *picture = choice->picture;
        list->knob.family = FAMILY_BOUNCES;
        for (unsigned n = 0; n <= 16 && n <= choice->deepest; n += n < 8 ? 1 : 2)
            if (!choice->quick || (n & (n - 1)) == 0)
                append_count(list, &picture->max_bounces, n, "bounce", "--max-bounces");
    }
    *picture = choice->picture;
    list->knob.family = FAMILY_LIGHT_SAMPLES;
    for (unsigned n = 1; n <= 1024 && choice->has_quad_lights; n *= choice->quick ? 4 : 2)
        append_count(list, &picture->light_samples, n, "light sample", "--light-samples");
    *picture = choice->picture;
}

size_t bench_settings(const struct bench_choice *choice, struct bench_setting settings[BENCH_MAX_SETTINGS])
{
    bool on_device = choice->backend == BACKEND_VULKAN;
    struct list list = {.settings = settings};
    for (int i = on_device ? 0 : DEVICE_MODES; i < (choice->quick ? QUICK_MODES : ALL_MODES); ++i) {
        list.knob = modes[i];
        list.knob.picture = choice->picture;
        if (list.knob.backend == BACKEND_CPU || list.knob.precision == PRECISION_FLOAT || choice->has_float64)
            append(&list);
    }
    list.knob = (struct bench_setting){.backend = choice->backend, .picture = choice->picture};
    list.label_end = "";
    list.options_end = on_device ? "" : " --backend cpu";
    append_knobs(&list, choice);
    if (on_device && !choice->quick) {
        list.knob.fast = true;
        list.label_end = ", fast";
        list.options_end = " --fast";
        append_knobs(&list, choice);
        list.knob.fast = false;
        list.label_end = list.options_end = "";
    }
    list.knob.family = FAMILY_SAMPLES;
    for (unsigned n = 1; n <= 1024; n *= choice->quick ? 4 : 2)
        append_count(&list, &list.knob.picture.samples, n, "sample", "--samples");
    return list.count;
}
