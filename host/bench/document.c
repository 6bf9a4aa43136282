#include "bench/document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "base/json.h"
#include "base/statistics.h"

enum { SLOPE_FROM = 4, SLOPE_TO = 256 };

static const char *const backend_names[] = {"vulkan", "cpu"};
static const char *const family_names[] = {"mode", "cpu", "max-error", "bounces", "light-samples", "samples"};

static bool is_filtered(const struct bench_point *point)
{
    return point->family == FAMILY_SAMPLES;
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

double bench_spread_ms(const json_t *point)
{
    const json_t *quartiles = json_object_get(point, "time_quartiles_ms");
    return json_number_value(json_array_get(quartiles, 1)) - json_number_value(json_array_get(quartiles, 0));
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

static json_t *describe_point(const struct bench_point *point)
{
    const struct picture_settings *picture = &point->picture;
    const struct reference_rays *rays = &point->rays;
    const struct bench_error *error = &point->error;
    double total = (double)(rays->primary + rays->secondary + rays->shadow);
    json_int_t threads = point->plan.threads ? point->plan.threads : sysconf(_SC_NPROCESSORS_ONLN);
    return json_pack(
        "{s:s, s:s, s:s, s:s, s:o, s:s, s:s, s:o, s:i, s:i, s:i, s:f, s:[f, f], s:i, s:f, s:f, "
        "s:{s:I, s:I, s:I}, s:o, s:{s:o, s:o, s:o, s:o, s:o, s:o, s:I}, s:b}",
        "label", point->label, "options", point->options, "family", family_names[point->family], "backend",
        backend_names[point->backend], "threads",
        point->backend == BACKEND_CPU ? json_integer(threads) : json_null(), "precision",
        precision_name(point->plan.precision), "mode", point->plan.fast ? "fast" : "exact", "max_error",
        picture->has_max_error ? json_real(picture->max_error) : json_null(), "max_bounces",
        (int)picture->max_bounces, "light_samples", (int)picture->light_samples, "samples",
        (int)picture->samples, "time_ms", point->median_ms, "time_quartiles_ms", point->quartiles_ms[0],
        point->quartiles_ms[1], "runs", (int)point->run_count, "first_ms", point->first_ms, "setup_ms",
        point->setup_ms, "rays", "primary", (json_int_t)rays->primary, "secondary",
        (json_int_t)rays->secondary, "shadow", (json_int_t)rays->shadow, "rays_per_second",
        json_real_or_null(total / point->median_ms * 1000), "error", "max", json_real_or_null(error->max),
        "rmse", json_real_or_null(error->rmse), "rmse_uncertainty",
        json_real_or_null(error->rmse_uncertainty), "absolute_999", json_real_or_null(error->absolute_999),
        "relative_median", json_real_or_null(error->relative_median), "relative_999",
        json_real_or_null(error->relative_999), "pixels_off_8bit", (json_int_t)error->pixels_off_8bit,
        "pareto", point->pareto);
}

/* How RMSE falls with the samples that the family varies. */
static json_t *describe_convergence(const struct bench *bench, enum bench_family family)
{
    json_t *values = json_array(), *rmse = json_array();
    double x[BENCH_MAX_SETTINGS], y[BENCH_MAX_SETTINGS];
    size_t fitted = 0;
    for (size_t i = 0; i < bench->count; ++i) {
        const struct bench_point *point = &bench->points[i];
        if (point->family != family || point->plan.fast)
            continue;
        unsigned samples = family == FAMILY_SAMPLES ? point->picture.samples : point->picture.light_samples;
        append(&values, json_integer(samples));
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

static json_t *describe_recommendation(const struct bench *bench, double error)
{
    const struct bench_point *best = bench_fastest_within(bench->points, bench->count, error);
    return json_pack("{s:f, s:s?, s:s?, s:o}", "error", error, "options", best ? best->options : NULL,
                     "backend", best ? backend_names[best->backend] : NULL, "time_ms",
                     best ? json_real(best->median_ms) : json_null());
}

enum status bench_describe(struct bench *bench, json_t **scene)
{
    const struct picture_settings *picture = &bench->picture;
    json_t *points = json_array(), *convergence = json_array(), *recommendations = json_array();
    bench_mark_pareto(bench->points, bench->count);
    for (size_t i = 0; i < bench->count; ++i)
        append(&points, describe_point(&bench->points[i]));
    if (bench->has_quad_lights)
        append(&convergence, describe_convergence(bench, FAMILY_LIGHT_SAMPLES));
    append(&convergence, describe_convergence(bench, FAMILY_SAMPLES));
    for (int i = 0; i < 4; ++i)
        append(&recommendations, describe_recommendation(bench, (const double[]){1e-2, 1e-3, 1e-4, 1e-5}[i]));
    *scene = json_pack("{s:s, s:i, s:i, s:i, s:i, s:i, s:b, s:s, s:s, s:o, s:o, s:o}", "scene",
                       bench->job.scene.path, "width", (int)picture->width, "height", (int)picture->height,
                       "max_bounces", (int)picture->max_bounces, "light_samples", (int)picture->light_samples,
                       "samples", (int)picture->samples, "sampled", bench->has_quad_lights, "truth",
                       bench->truth.text, "truth_samples", bench->filtered.text, "points", points,
                       "convergence", convergence, "recommendations", recommendations);
    if (*scene)
        return STATUS_DONE;
    log_error("no memory for the result of %s, or its name is not UTF-8", bench->job.scene.path);
    return STATUS_UNABLE;
}

/* The command line, for people; the caller frees it. NULL without memory. */
static char *join_words(int count, char **words)
{
    char *command = NULL;
    size_t size;
    FILE *stream = open_memstream(&command, &size);
    if (!stream)
        return NULL;
    fputs("vkwhitted", stream);
    for (int i = 1; i < count; ++i)
        fprintf(stream, " %s", words[i]);
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

enum status bench_document(int argc, char **argv, bool quick, const struct vulkan_context *context,
                           json_t **document)
{
    char date[32], processor[256], *command = join_words(argc, argv);
    time_t now = time(NULL);
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime(&now));
    name_processor(processor);
    *document = json_pack(
        "{s:s, s:s, s:s, s:s, s:b, s:{s:s, s:i, s:s, s:s*, s:o*}, s:[]}", "program", "vkwhitted", "version",
        VKWHITTED_VERSION, "command", command, "date", date, "quick", quick, "machine", "processor",
        processor, "cores", (int)sysconf(_SC_NPROCESSORS_ONLN), "compiler",
#ifdef __clang__
        "clang " __clang_version__,
#else
        "gcc " __VERSION__,
#endif
        "device", context ? context->properties.deviceName : NULL, "driver",
        context ? json_sprintf("%s %s", context->driver.driverName, context->driver.driverInfo) : NULL,
        "scenes");
    free(command);
    if (*document)
        return STATUS_DONE;
    log_error("no memory for the results, or the command line is not UTF-8");
    return STATUS_UNABLE;
}
