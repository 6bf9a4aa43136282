#include "bench/settings.h"

#include <stdarg.h>
#include <stdio.h>

const char *bench_family_name(enum bench_family family)
{
    static const char *const names[] = {"mode", "cpu", "max-error", "bounces", "light-samples", "samples"};
    return names[family];
}

struct list {
    const struct bench_choice *choice;
    struct bench_setting *settings;
    size_t count;
};

/* Appends a copy of the setting with its label and the options that choose it. */
__attribute__((format(printf, 4, 5))) static void append(struct list *list, struct bench_setting setting,
                                                         const char *label, const char *options, ...)
{
    if (list->count == BENCH_MAX_SETTINGS)
        return;
    struct bench_setting *place = &list->settings[list->count++];
    *place = setting;
    snprintf(place->label, sizeof place->label, "%s%s%s", label, *label && setting.fast ? ", " : "",
             setting.fast ? "fast" : "");
    va_list arguments;
    va_start(arguments, options);
    int length = vsnprintf(place->options, sizeof place->options, options, arguments);
    va_end(arguments);
    const char *rest = setting.fast ? "--fast" : list->choice->backend == BACKEND_CPU ? "--backend cpu" : "";
    if (setting.family >= FAMILY_MAX_ERROR && *rest && length >= 0)
        snprintf(place->options + length, sizeof place->options - (size_t)length, " %s", rest);
}

static void append_modes(struct list *list)
{
    struct bench_setting device = {.family = FAMILY_MODE, .picture = list->choice->picture};
    struct bench_setting fast = device, wide = device;
    if (list->choice->backend == BACKEND_VULKAN) {
        fast.fast = true;
        wide.precision = PRECISION_DOUBLE;
        append(list, device, "exact", "%s", "");
        append(list, fast, "", "--fast");
        if (list->choice->has_float64)
            append(list, wide, "double", "--precision double");
    }
    struct bench_setting cpu = device, one = device, precise = device;
    cpu.family = one.family = precise.family = FAMILY_CPU;
    cpu.backend = one.backend = precise.backend = BACKEND_CPU;
    one.threads = 1;
    precise.precision = PRECISION_DOUBLE;
    append(list, cpu, "CPU", "--backend cpu");
    append(list, one, "CPU, 1 thread", "--backend cpu --threads 1");
    append(list, precise, "CPU, double", "--backend cpu --precision double");
    precise.threads = 1;
    if (!list->choice->quick)
        append(list, precise, "CPU, double, 1 thread", "--backend cpu --precision double --threads 1");
}

static void append_max_errors(struct list *list, struct bench_setting setting)
{
    static const char *const all[] = {"1e-1", "1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "0"};
    static const double values[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0};
    setting.family = FAMILY_MAX_ERROR;
    setting.picture.has_max_error = true;
    setting.picture.max_bounces = list->choice->deepest;
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        char label[32];
        if (list->choice->quick && (i == 4 || i == 5))
            continue;
        setting.picture.max_error = values[i];
        snprintf(label, sizeof label, "max error %s", all[i]);
        append(list, setting, label, "--max-error %s --max-bounces %u", all[i], list->choice->deepest);
    }
}

static void append_bounces(struct list *list, struct bench_setting setting)
{
    static const unsigned quick[] = {0, 1, 2, 4, 8, 16}, full[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16};
    const unsigned *values = list->choice->quick ? quick : full;
    size_t count = list->choice->quick ? sizeof quick / sizeof *quick : sizeof full / sizeof *full;
    setting.family = FAMILY_BOUNCES;
    for (size_t i = 0; i < count && values[i] <= list->choice->deepest; ++i) {
        char label[32];
        setting.picture.max_bounces = values[i];
        snprintf(label, sizeof label, "%u bounce%s", values[i], values[i] == 1 ? "" : "s");
        append(list, setting, label, "--max-bounces %u", values[i]);
    }
}

static void append_light_samples(struct list *list, struct bench_setting setting)
{
    setting.family = FAMILY_LIGHT_SAMPLES;
    for (unsigned n = 1; n <= 1024; n *= list->choice->quick ? 4 : 2) {
        char label[32];
        setting.picture.light_samples = n;
        snprintf(label, sizeof label, "%u light sample%s", n, n == 1 ? "" : "s");
        append(list, setting, label, "--light-samples %u", n);
    }
}

static void append_samples(struct list *list, struct bench_setting setting)
{
    setting.family = FAMILY_SAMPLES;
    for (unsigned n = 1; n <= 1024; n *= list->choice->quick ? 4 : 2) {
        char label[32];
        setting.picture.samples = n;
        snprintf(label, sizeof label, "%u sample%s", n, n == 1 ? "" : "s");
        append(list, setting, label, "--samples %u", n);
    }
}

size_t bench_settings(const struct bench_choice *choice, struct bench_setting *settings)
{
    struct list list = {.choice = choice, .settings = settings};
    append_modes(&list);
    /* The knobs in exact mode and, where there is such a thing and time for it, in fast mode. */
    int modes = choice->backend == BACKEND_VULKAN && !choice->quick ? 2 : 1;
    for (int fast = 0; fast < modes; ++fast) {
        struct bench_setting setting = {
            .backend = choice->backend,
            .fast = fast,
            .picture = choice->picture,
        };
        if (choice->has_secondary_rays) {
            append_max_errors(&list, setting);
            append_bounces(&list, setting);
        }
        if (choice->has_quad_lights)
            append_light_samples(&list, setting);
    }
    append_samples(&list, (struct bench_setting){.backend = choice->backend, .picture = choice->picture});
    return list.count;
}
