#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/statistics.h"
#include "base/text_file.h"
#include "bench/document.h"

enum { MOST_BYTES = 256 << 20 }; /* of a document */

static const double standard_errors = 4, least_change = 0.05, printing_error = 1e-6;

/* The variance of a median is so many times that of the values, by their number. */
static const double median_factor = 1.2533 * 1.2533;

/* The distance of the quartiles in standard deviations. */
static const double quartile_distance = 1.349;

enum status bench_document_read(const char *path, json_t **document)
{
    json_error_t error;
    size_t length;
    char *text = text_file_read(path, false, MOST_BYTES, &length);
    *document = NULL;
    if (!text)
        return input_file_refuse(path);
    *document = json_loadb(text, length, JSON_REJECT_DUPLICATES, &error);
    free(text);
    if (json_is_array(json_object_get(*document, "scenes")) &&
        json_is_object(json_object_get(*document, "machine")))
        return STATUS_DONE;
    const bool is_json = *document,
               no_memory = !is_json && json_error_code(&error) == json_error_out_of_memory;
    if (is_json)
        log_error("%s: expected a file that bench --json wrote", path);
    else
        log_error("%s:%d:%d: %s", path, error.line, error.column, error.text);
    json_decref(*document);
    *document = NULL;
    return no_memory ? STATUS_UNABLE : STATUS_REFUSED;
}

static bool same_text(const json_t *a, const json_t *b, const char *key)
{
    return strcmp(bench_text(a, key), bench_text(b, key)) == 0;
}

/* The element of the array with the same text at the key; NULL if there is none. */
static const json_t *find(const json_t *array, const json_t *like, const char *key)
{
    const json_t *element;
    size_t i;
    json_array_foreach(array, i, element)
    {
        if (same_text(element, like, key))
            return element;
    }
    return NULL;
}

/* A setting in both benches. */
struct pair {
    const json_t *old, *new;
    double change; /* logarithm of new time by old time */
    bool on_cpu;
};

struct comparing {
    FILE *stream;
    bool times;              /* can be compared */
    const json_t *old, *new; /* the scene */
    struct pair pairs[BENCH_MAX_SETTINGS];
    size_t count;
    double old_spread, new_spread; /* typical ones, relative */
    size_t compared, worse, better;
};

static double relative_spread(const json_t *point)
{
    double spread = bench_spread_ms(point) / bench_number(point, "time_ms");
    return spread >= 0 && isfinite(spread) ? spread : 0;
}

static double median(double *values, size_t count)
{
    sort_doubles(values, count);
    return sorted_quantile(values, count, 0.5);
}

/* How the machine as a whole has changed from one bench to the other, as the settings of one backend tell:
 * the median change and its variance, both 0 where they do not tell. */
static double find_drift(const struct comparing *comparing, bool on_cpu, double *variance)
{
    double changes[BENCH_MAX_SETTINGS], sum = 0, squares = 0;
    size_t count = 0;
    for (size_t i = 0; i < comparing->count; ++i) {
        const struct pair *pair = &comparing->pairs[i];
        if (pair->on_cpu != on_cpu || !isfinite(pair->change))
            continue;
        changes[count++] = pair->change;
        sum += pair->change;
        squares += pair->change * pair->change;
    }
    double n = (double)count;
    *variance = count < 2 ? 0 : median_factor * fmax(squares - sum * sum / n, 0) / (n - 1) / n;
    return count < 2 ? 0 : median(changes, count);
}

static void find_pairs(struct comparing *comparing)
{
    double old_spreads[BENCH_MAX_SETTINGS], new_spreads[BENCH_MAX_SETTINGS];
    const json_t *point;
    size_t i, count = 0;
    json_array_foreach(json_object_get(comparing->new, "points"), i, point)
    {
        const json_t *old = find(json_object_get(comparing->old, "points"), point, "options");
        if (!old || count == BENCH_MAX_SETTINGS)
            continue;
        old_spreads[count] = relative_spread(old);
        new_spreads[count] = relative_spread(point);
        comparing->pairs[count++] = (struct pair){
            .old = old,
            .new = point,
            .change = log(bench_number(point, "time_ms") / bench_number(old, "time_ms")),
            .on_cpu = strcmp(bench_text(point, "backend"), "cpu") == 0,
        };
    }
    comparing->count = count;
    comparing->old_spread = median(old_spreads, count);
    comparing->new_spread = median(new_spreads, count);
}

/* Notes a change for the better or the worse, which is up, and says so with one of the two texts. */
static void note_change(struct comparing *comparing, const struct pair *pair, const char *const texts[2],
                        double before, double after, const char *unit)
{
    const char *options = bench_text(pair->new, "options");
    const bool worse = after > before;
    fprintf(comparing->stream, "%s: %s: %s: %.3g%s, was %.3g%s\n", bench_text(comparing->new, "scene"),
            *options ? options : "as the scene says", texts[worse], after, unit, before, unit);
    comparing->worse += worse;
    comparing->better += !worse;
}

/* Of the point's median time, relative to it. */
static double time_variance(const json_t *point, double typical_spread)
{
    double deviation = fmax(relative_spread(point), typical_spread) / quartile_distance;
    return median_factor * deviation * deviation / fmax(bench_number(point, "runs"), 1);
}

static bool is_beyond(double change, double variance)
{
    return fabs(change) > fmax(log1p(least_change), standard_errors * sqrt(variance));
}

static void compare_times(struct comparing *comparing, const struct pair *pair)
{
    double drift_variance, own = pair->change - find_drift(comparing, !pair->on_cpu, &drift_variance);
    double variance =
        time_variance(pair->old, comparing->old_spread) + time_variance(pair->new, comparing->new_spread);
    if (is_beyond(pair->change, variance) && own * pair->change >= 0 &&
        is_beyond(own, variance + drift_variance))
        note_change(comparing, pair, (const char *const[]){"faster", "SLOWER"},
                    bench_number(pair->old, "time_ms"), bench_number(pair->new, "time_ms"), " ms");
}

static void compare_errors(struct comparing *comparing, const struct pair *pair)
{
    static const struct {
        const char *key, *texts[2];
    } errors[] = {{"rmse", {"more accurate, RMSE", "LESS ACCURATE, RMSE"}},
                  {"max", {"more accurate, largest error", "LESS ACCURATE, largest error"}}};
    const json_t *old = json_object_get(pair->old, "error"), *new = json_object_get(pair->new, "error");
    bool sampled =
        bench_number(pair->new, "samples") > 1 || json_is_true(json_object_get(comparing->new, "sampled"));
    double noise =
        standard_errors * hypot(bench_number(old, "rmse_uncertainty"), bench_number(new, "rmse_uncertainty"));
    for (int i = 0; i < (sampled ? 1 : 2); ++i) {
        double before = bench_number(old, errors[i].key), after = bench_number(new, errors[i].key);
        if (before == after || !(fabs(after - before) > fmax(sampled ? noise : 0, printing_error * before)))
            continue;
        note_change(comparing, pair, errors[i].texts, before, after, "");
        return;
    }
}

static void compare_scenes(struct comparing *comparing)
{
    const json_t *old = comparing->old, *new = comparing->new;
    const char *name = bench_text(new, "scene");
    if (bench_number(old, "width") != bench_number(new, "width") ||
        bench_number(old, "height") != bench_number(new, "height")) {
        fprintf(comparing->stream, "%s: another size: not compared\n", name);
        return;
    }
    bool same_truth[] = {same_text(old, new, "truth"), same_text(old, new, "truth_samples")};
    for (int filtered = 0; filtered < 2; ++filtered)
        if (!same_truth[filtered])
            fprintf(comparing->stream, "%s: another truth%s: errors are not compared\n", name,
                    filtered ? " for samples" : "");
    find_pairs(comparing);
    for (size_t i = 0; i < comparing->count; ++i) {
        if (comparing->times)
            compare_times(comparing, &comparing->pairs[i]);
        if (same_truth[bench_is_filtered(comparing->pairs[i].new)])
            compare_errors(comparing, &comparing->pairs[i]);
    }
    comparing->compared += comparing->count;
}

/* A text or an integer, or else "none". */
static void write_value(const json_t *value, char text[256])
{
    if (json_is_integer(value))
        snprintf(text, 256, "%lld", (long long)json_integer_value(value));
    else
        snprintf(text, 256, "%s", json_is_string(value) ? json_string_value(value) : "none");
}

/* Says where the bench ran elsewhere, and returns whether it did not. */
static bool same_machine(const json_t *old, const json_t *new, FILE *stream)
{
    static const char *const keys[] = {"processor", "cores", "device", "driver"};
    bool same = true;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i) {
        char before[256], now[256];
        write_value(json_object_get(old, keys[i]), before);
        write_value(json_object_get(new, keys[i]), now);
        if (strcmp(before, now) == 0)
            continue;
        fprintf(stream, "another machine: %s %s, was %s\n", keys[i], now, before);
        same = false;
    }
    if (!same)
        fputs("times are not compared\n", stream);
    return same;
}

enum status bench_compare(const json_t *old, const json_t *new, FILE *stream)
{
    struct comparing comparing = {.stream = stream};
    const json_t *scene;
    size_t i;
    comparing.times = same_machine(json_object_get(old, "machine"), json_object_get(new, "machine"), stream);
    json_array_foreach(json_object_get(new, "scenes"), i, scene)
    {
        comparing.old = find(json_object_get(old, "scenes"), scene, "scene");
        comparing.new = scene;
        if (comparing.old)
            compare_scenes(&comparing);
        else
            fprintf(stream, "%s: not measured before\n", bench_text(scene, "scene"));
    }
    if (comparing.compared == 0) {
        log_error("--compare: the earlier bench has no scene, size and setting in common with this one");
        return STATUS_REFUSED;
    }
    fprintf(stream, "compared %zu settings: %zu became worse, %zu better beyond noise\n", comparing.compared,
            comparing.worse, comparing.better);
    return comparing.worse > 0 ? STATUS_DIFFERS : STATUS_DONE;
}
