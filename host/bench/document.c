#include "bench/document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/statistics.h"
#include "bench/machine.h"
#include "bench/pareto.h"

enum { SLOPE_FROM = 4, SLOPE_TO = 256 };

/* JSON has no infinity and no NaN. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* The points that share a truth, as arrays of the same length. */
struct selection {
    size_t count, index[BENCH_MAX_SETTINGS];
    double times[BENCH_MAX_SETTINGS], errors[BENCH_MAX_SETTINGS]; /* within which 99.9 % of the pixels are */
};

static struct selection select_points(const struct bench_point *points, size_t count, bool filtered)
{
    struct selection selection = {.count = 0};
    for (size_t i = 0; i < count; ++i) {
        if ((points[i].setting.family == FAMILY_SAMPLES) != filtered)
            continue;
        selection.index[selection.count] = i;
        selection.times[selection.count] = bench_point_times(&points[i]).median;
        selection.errors[selection.count++] = points[i].error.absolute_999;
    }
    return selection;
}

void bench_mark_pareto(struct bench_point *points, size_t count)
{
    for (int filtered = 0; filtered < 2; ++filtered) {
        struct selection selection = select_points(points, count, filtered);
        bool front[BENCH_MAX_SETTINGS];
        pareto_front(selection.times, selection.errors, selection.count, front);
        for (size_t i = 0; i < selection.count; ++i)
            points[selection.index[i]].pareto = front[i];
    }
}

static json_t *describe_error(const struct bench_error *error)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:I}", "max", number(error->max), "rmse",
                     number(error->rmse), "rmse_uncertainty", number(error->rmse_uncertainty), "absolute_999",
                     number(error->absolute_999), "relative_median", number(error->relative_median),
                     "relative_999", number(error->relative_999), "pixels_off_8bit",
                     (json_int_t)error->pixels_off_8bit);
}

static json_t *describe_point(const struct bench_result *result, const struct bench_point *point)
{
    const struct bench_setting *setting = &point->setting;
    const struct picture_settings *picture = &setting->picture;
    const struct bench_times times = bench_point_times(point);
    const struct reference_rays *rays = &point->rays;
    double total = (double)(rays->primary + rays->secondary + rays->shadow);
    bool on_cpu = setting->backend == BACKEND_CPU;
    bool metered = point->joules >= 0 && (on_cpu || result->meters_device);
    return json_pack(
        "{s:s, s:s, s:s, s:s, s:o, s:s, s:s, s:o, s:i, s:i, s:i, s:f, s:[f, f], s:i, s:f, s:f, "
        "s:{s:I, s:I, s:I}, s:o, s:o, s:o, s:b}",
        "label", setting->label, "options", setting->options, "family", bench_family_name(setting->family),
        "backend", on_cpu ? "cpu" : "vulkan", "threads",
        on_cpu ? json_integer(setting->threads ? (json_int_t)setting->threads : sysconf(_SC_NPROCESSORS_ONLN))
               : json_null(),
        "precision", precision_name(setting->precision), "mode", setting->fast ? "fast" : "exact",
        "max_error", picture->has_max_error ? json_real(picture->max_error) : json_null(), "max_bounces",
        (int)picture->max_bounces, "light_samples", (int)picture->light_samples, "samples",
        (int)picture->samples, "time_ms", times.median, "time_quartiles_ms", times.quartiles[0],
        times.quartiles[1], "runs", (int)point->run_count, "first_ms", point->first_ms, "setup_ms",
        point->setup_ms, "rays", "primary", (json_int_t)rays->primary, "secondary",
        (json_int_t)rays->secondary, "shadow", (json_int_t)rays->shadow, "rays_per_second",
        number(total / times.median * 1000), "energy_joules",
        metered ? json_real(point->joules / (double)point->run_count) : json_null(), "error",
        describe_error(&point->error), "pareto", point->pareto);
}

static json_t *describe_convergence(const struct bench_result *result, enum bench_family family)
{
    json_t *values = json_array(), *rmse = json_array();
    double x[BENCH_MAX_SETTINGS], y[BENCH_MAX_SETTINGS];
    size_t fitted = 0;
    for (size_t i = 0; i < result->count; ++i) {
        const struct bench_point *point = &result->points[i];
        const struct picture_settings *picture = &point->setting.picture;
        if (point->setting.family != family || point->setting.fast)
            continue;
        unsigned samples = family == FAMILY_SAMPLES ? picture->samples : picture->light_samples;
        json_array_append_new(values, json_integer((json_int_t)samples));
        json_array_append_new(rmse, number(point->error.rmse));
        if (samples < SLOPE_FROM || samples > SLOPE_TO)
            continue;
        x[fitted] = samples;
        y[fitted++] = point->error.rmse;
    }
    return json_pack("{s:s, s:o, s:o, s:o, s:i, s:i}", "family", bench_family_name(family), "values", values,
                     "rmse", rmse, "slope", number(log_log_slope(x, y, fitted)), "slope_from", SLOPE_FROM,
                     "slope_to", SLOPE_TO);
}

static json_t *describe_recommendations(const struct bench_result *result)
{
    json_t *recommendations = json_array();
    struct selection selection = select_points(result->points, result->count, false);
    static const double errors[] = {1e-2, 1e-3, 1e-4, 1e-5};
    for (size_t i = 0; i < sizeof errors / sizeof *errors; ++i) {
        size_t best = fastest_within(selection.times, selection.errors, selection.count, errors[i]);
        json_t *line = json_pack("{s:f, s:n, s:n}", "error", errors[i], "options", "time_ms");
        if (best < selection.count) {
            const struct bench_setting *setting = &result->points[selection.index[best]].setting;
            json_object_set_new(line, "options", json_string(setting->options));
            json_object_set_new(line, "backend",
                                json_string(setting->backend == BACKEND_CPU ? "cpu" : "vulkan"));
            json_object_set_new(line, "time_ms", json_real(selection.times[best]));
        }
        json_array_append_new(recommendations, line);
    }
    return recommendations;
}

static json_t *describe_rounding(const struct bench_result *result)
{
    const struct judgement *rounding = &result->rounding;
    return json_pack("{s:s, s:I, s:o, s:o, s:o, s:o, s:I}", "against", "quad", "pixels",
                     (json_int_t)result->rounding_pixels, "median", number(rounding->median), "p99",
                     number(rounding->percentile_99), "p9999", number(rounding->percentile_99_99), "max",
                     number(rounding->max), "unexplained", (json_int_t)rounding->unexplained);
}

json_t *bench_scene_document(const struct bench_result *result)
{
    const struct picture_settings *picture = &result->picture;
    json_t *points = json_array(), *convergence = json_array();
    bool lights = false;
    for (size_t i = 0; i < result->count; ++i) {
        json_array_append_new(points, describe_point(result, &result->points[i]));
        lights = lights || result->points[i].setting.family == FAMILY_LIGHT_SAMPLES;
    }
    if (lights)
        json_array_append_new(convergence, describe_convergence(result, FAMILY_LIGHT_SAMPLES));
    json_array_append_new(convergence, describe_convergence(result, FAMILY_SAMPLES));
    json_t *agreement =
        result->has_agreement
            ? json_pack("{s:I, s:I}", "differing_pixels", (json_int_t)result->agreement.bit_differing,
                        "pixels", (json_int_t)picture->width * picture->height)
            : json_null();
    return json_pack("{s:s, s:i, s:i, s:i, s:i, s:i, s:b, s:s, s:I, s:s, s:I, s:o, s:o, s:o, s:o, s:o}",
                     "scene", result->path, "width", (int)picture->width, "height", (int)picture->height,
                     "max_bounces", (int)picture->max_bounces, "light_samples", (int)picture->light_samples,
                     "samples", (int)picture->samples, "sampled", lights, "truth", result->truth->text,
                     "truth_pixels", (json_int_t)pixel_grid_count(&result->truth->grid), "truth_samples",
                     result->filtered->text, "truth_samples_pixels",
                     (json_int_t)pixel_grid_count(&result->filtered->grid), "points", points, "convergence",
                     convergence, "agreement", agreement, "rounding", describe_rounding(result),
                     "recommendations", describe_recommendations(result));
}

/* The command line as a shell would read it; NULL without memory. */
static char *quote_command(int count, char **arguments)
{
    size_t size = 1;
    for (int i = 0; i < count; ++i)
        size += 4 * strlen(arguments[i]) + 3;
    char *command = calloc(size, 1), *end = command;
    for (int i = 0; i < count && command; ++i) {
        const char *argument = i == 0 ? "vkwhitted" : arguments[i];
        static const char plain[] =
            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
        bool quoted = !*argument || argument[strspn(argument, plain)];
        end += sprintf(end, "%s%s", i > 0 ? " " : "", quoted ? "'" : "");
        for (; *argument; ++argument)
            end += sprintf(end, *argument == '\'' ? "'\\''" : "%c", *argument);
        end += sprintf(end, "%s", quoted ? "'" : "");
    }
    return command;
}

json_t *bench_document(int argc, char **argv, bool quick, const struct vulkan_context *context)
{
    char date[32];
    time_t now = time(NULL);
    struct tm utc;
    gmtime_r(&now, &utc);
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    char *command = quote_command(argc, argv);
    json_t *document = json_pack("{s:s, s:s, s:s, s:s, s:b, s:o, s:[]}", "program", "vkwhitted", "version",
                                 VKWHITTED_VERSION, "command", command, "date", date, "quick", quick,
                                 "machine", machine_describe(context), "scenes");
    free(command);
    return document;
}
