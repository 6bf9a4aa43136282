#include "bench/document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "base/json.h"
#include "base/statistics.h"

enum { SLOPE_FROM = 4, SLOPE_TO = 256 };

static const char *const family_names[] = {"mode", "cpu", "max-error", "bounces", "light-samples", "samples"};

static bool is_filtered(const struct bench_point *point)
{
    return point->setting.family == FAMILY_SAMPLES;
}

static bool beats(const struct bench_point *a, const struct bench_point *b)
{
    double error = a->error.absolute_999, other = b->error.absolute_999;
    return is_filtered(a) == is_filtered(b) && a->median_ms <= b->median_ms && error <= other &&
           (a->median_ms < b->median_ms || error < other);
}

void bench_mark_pareto(struct bench_point *points, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        points[i].pareto = isfinite(points[i].error.absolute_999);
        for (size_t k = 0; k < count && points[i].pareto; ++k)
            points[i].pareto = !beats(&points[k], &points[i]);
    }
}

const struct bench_point *bench_fastest_within(const struct bench_point *points, size_t count, double within)
{
    const struct bench_point *best = NULL;
    for (size_t i = 0; i < count; ++i)
        if (!is_filtered(&points[i]) && points[i].error.absolute_999 <= within &&
            (!best || points[i].median_ms < best->median_ms))
            best = &points[i];
    return best;
}

double bench_number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : INFINITY;
}

const char *bench_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

bool bench_is_filtered(const json_t *point)
{
    return strcmp(bench_text(point, "family"), family_names[FAMILY_SAMPLES]) == 0;
}

/* Appends the value, or without memory for either sets *array to NULL, which json_pack() takes for a failure.
 */
static void append(json_t **array, json_t *value)
{
    if (json_array_append_new(*array, value) == 0)
        return;
    json_decref(*array);
    *array = NULL;
}

static json_t *describe_error(const struct bench_error *error)
{
    return json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:I}", "max", json_real_or_null(error->max), "rmse",
        json_real_or_null(error->rmse), "rmse_uncertainty", json_real_or_null(error->rmse_uncertainty),
        "absolute_999", json_real_or_null(error->absolute_999), "relative_median",
        json_real_or_null(error->relative_median), "relative_999", json_real_or_null(error->relative_999),
        "pixels_off_8bit", (json_int_t)error->pixels_off_8bit);
}

static json_t *describe_point(const struct bench_point *point)
{
    const struct bench_setting *setting = &point->setting;
    const struct picture_settings *picture = &setting->picture;
    const struct reference_rays *rays = &point->rays;
    double total = (double)(rays->primary + rays->secondary + rays->shadow);
    bool on_cpu = setting->backend == BACKEND_CPU;
    json_int_t threads = setting->threads ? (json_int_t)setting->threads : sysconf(_SC_NPROCESSORS_ONLN);
    return json_pack(
        "{s:s, s:s, s:s, s:s, s:o, s:s, s:s, s:o, s:i, s:i, s:i, s:f, s:[f, f], s:i, s:f, s:f, "
        "s:{s:I, s:I, s:I}, s:o, s:o, s:b}",
        "label", setting->label, "options", setting->options, "family", family_names[setting->family],
        "backend", on_cpu ? "cpu" : "vulkan", "threads", on_cpu ? json_integer(threads) : json_null(),
        "precision", precision_name(setting->precision), "mode", setting->fast ? "fast" : "exact",
        "max_error", picture->has_max_error ? json_real(picture->max_error) : json_null(), "max_bounces",
        (int)picture->max_bounces, "light_samples", (int)picture->light_samples, "samples",
        (int)picture->samples, "time_ms", point->median_ms, "time_quartiles_ms", point->quartiles_ms[0],
        point->quartiles_ms[1], "runs", (int)point->run_count, "first_ms", point->first_ms, "setup_ms",
        point->setup_ms, "rays", "primary", (json_int_t)rays->primary, "secondary",
        (json_int_t)rays->secondary, "shadow", (json_int_t)rays->shadow, "rays_per_second",
        json_real_or_null(total / point->median_ms * 1000), "error", describe_error(&point->error), "pareto",
        point->pareto);
}

/* How RMSE falls with the samples that the family varies. */
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
        append(&values, json_integer((json_int_t)samples));
        append(&rmse, json_real_or_null(point->error.rmse));
        if (samples < SLOPE_FROM || samples > SLOPE_TO)
            continue;
        x[fitted] = samples;
        y[fitted++] = point->error.rmse;
    }
    return json_pack("{s:s, s:o, s:o, s:o, s:i, s:i}", "family", family_names[family], "values", values,
                     "rmse", rmse, "slope", json_real_or_null(log_log_slope(x, y, fitted)), "slope_from",
                     SLOPE_FROM, "slope_to", SLOPE_TO);
}

static json_t *describe_recommendation(const struct bench_result *result, double error)
{
    const struct bench_point *best = bench_fastest_within(result->points, result->count, error);
    if (!best)
        return json_pack("{s:f, s:n, s:n, s:n}", "error", error, "options", "backend", "time_ms");
    return json_pack("{s:f, s:s, s:s, s:f}", "error", error, "options", best->setting.options, "backend",
                     best->setting.backend == BACKEND_CPU ? "cpu" : "vulkan", "time_ms", best->median_ms);
}

static json_t *describe_rounding(const struct bench_result *result)
{
    const struct judgement *rounding = &result->rounding;
    return json_pack("{s:s, s:I, s:o, s:o, s:o, s:o, s:I}", "against", "quad", "pixels",
                     (json_int_t)result->rounding_pixels, "median", json_real_or_null(rounding->median),
                     "p99", json_real_or_null(rounding->percentile_99), "p9999",
                     json_real_or_null(rounding->percentile_99_99), "max", json_real_or_null(rounding->max),
                     "unexplained", (json_int_t)rounding->unexplained);
}

json_t *bench_scene_document(const struct bench_result *result)
{
    const struct picture_settings *picture = &result->picture;
    json_t *points = json_array(), *convergence = json_array(), *agreement = json_null();
    for (size_t i = 0; i < result->count; ++i)
        append(&points, describe_point(&result->points[i]));
    if (result->sampled)
        append(&convergence, describe_convergence(result, FAMILY_LIGHT_SAMPLES));
    append(&convergence, describe_convergence(result, FAMILY_SAMPLES));
    if (result->has_agreement)
        agreement = json_pack("{s:I, s:I}", "differing_pixels", (json_int_t)result->differing, "pixels",
                              (json_int_t)picture->width * picture->height);
    return json_pack(
        "{s:s, s:i, s:i, s:i, s:i, s:i, s:b, s:s, s:I, s:s, s:I, s:o, s:o, s:o, s:o, s:[o, o, o, o]}",
        "scene", result->path, "width", (int)picture->width, "height", (int)picture->height, "max_bounces",
        (int)picture->max_bounces, "light_samples", (int)picture->light_samples, "samples",
        (int)picture->samples, "sampled", result->sampled, "truth", result->truth.text, "truth_pixels",
        (json_int_t)pixel_grid_count(&result->truth.pixels.grid), "truth_samples", result->filtered.text,
        "truth_samples_pixels", (json_int_t)pixel_grid_count(&result->filtered.pixels.grid), "points", points,
        "convergence", convergence, "agreement", agreement, "rounding", describe_rounding(result),
        "recommendations", describe_recommendation(result, 1e-2), describe_recommendation(result, 1e-3),
        describe_recommendation(result, 1e-4), describe_recommendation(result, 1e-5));
}

/* The command line as a shell would read it; the caller frees it. NULL without memory. */
static char *quote_command(int count, char **arguments)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    char *command = NULL;
    size_t size;
    FILE *stream = open_memstream(&command, &size);
    if (!stream)
        return NULL;
    fputs("vkwhitted", stream);
    for (int i = 1; i < count; ++i) {
        bool quoted = !*arguments[i] || arguments[i][strspn(arguments[i], plain)];
        fputs(quoted ? " '" : " ", stream);
        for (const char *c = arguments[i]; *c; ++c)
            fprintf(stream, *c == '\'' ? "'\\''" : "%c", *c);
        fputs(quoted ? "'" : "", stream);
    }
    if (fclose(stream) == 0)
        return command;
    free(command);
    return NULL;
}

/* The processor's name as Linux tells it, or else its architecture. */
static void name_processor(char name[256])
{
    char line[256];
    struct utsname system = {.machine = "unknown"};
    uname(&system);
    strcpy(name, system.machine);
    FILE *file = fopen("/proc/cpuinfo", "re");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "model name%*[ \t:]%255[^\n]", name) == 1)
            break;
    if (file)
        fclose(file);
}

/* What times depend on. */
static json_t *describe_machine(const struct vulkan_context *context)
{
    char processor[256];
    name_processor(processor);
    json_t *machine = json_pack("{s:s, s:i, s:s}", "processor", processor, "cores",
                                (int)sysconf(_SC_NPROCESSORS_ONLN), "compiler",
#ifdef __clang__
                                "clang " __clang_version__
#else
                                "gcc " __VERSION__
#endif
    );
    if (context) {
        const VkPhysicalDeviceDriverProperties *driver = &context->driver;
        json_object_set_new(machine, "device", json_string(context->properties.deviceName));
        json_object_set_new(machine, "driver", json_sprintf("%s %s", driver->driverName, driver->driverInfo));
    }
    return machine;
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
                                 "machine", describe_machine(context), "scenes");
    free(command);
    return document;
}
