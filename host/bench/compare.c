#include "bench/compare.h"

#include <math.h>
#include <string.h>

#include "base/statistics.h"
#include "bench/json_value.h"

enum { MAX_POINTS = 256 };

static const double standard_errors = 4, least_change = 0.05, printing_error = 1e-6;

/* Null stands for what is not finite. */
static double number_of(const json_t *object, const char *key)
{
    double value = json_number_at(object, key);
    return isnan(value) ? INFINITY : value;
}

enum status bench_document_read(const char *path, json_t **document)
{
    json_error_t error;
    *document = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!*document) {
        if (error.line > 0)
            log_error("%s:%d:%d: %s", path, error.line, error.column, error.text);
        else
            log_error("%s: %s", path, error.text);
        return STATUS_REFUSED;
    }
    if (json_is_array(json_object_get(*document, "scenes")) &&
        json_is_object(json_object_get(*document, "machine")))
        return STATUS_DONE;
    log_error("%s: expected a file that bench --json wrote", path);
    json_decref(*document);
    *document = NULL;
    return STATUS_REFUSED;
}

static bool same_text(const json_t *a, const json_t *b, const char *key)
{
    return strcmp(json_text_at(a, key), json_text_at(b, key)) == 0;
}

static const json_t *find_scene(const json_t *document, const json_t *like)
{
    const json_t *scene;
    size_t i;
    json_array_foreach(json_object_get(document, "scenes"), i, scene)
    {
        if (same_text(scene, like, "scene"))
            return scene;
    }
    return NULL;
}

static const json_t *find_point(const json_t *scene, const json_t *like)
{
    const json_t *point;
    size_t i;
    json_array_foreach(json_object_get(scene, "points"), i, point)
    {
        if (same_text(point, like, "family") && same_text(point, like, "options"))
            return point;
    }
    return NULL;
}

/* Distance of the quartiles by the median. */
static double relative_spread(const json_t *point)
{
    const json_t *quartiles = json_object_get(point, "time_quartiles_ms");
    double spread =
        (json_number_value(json_array_get(quartiles, 1)) - json_number_value(json_array_get(quartiles, 0))) /
        number_of(point, "time_ms");
    return spread >= 0 && isfinite(spread) ? spread : 0;
}

static double typical_spread(const json_t *scene)
{
    double spreads[MAX_POINTS];
    size_t count = 0, i;
    const json_t *point;
    json_array_foreach(json_object_get(scene, "points"), i, point)
    {
        if (count < MAX_POINTS)
            spreads[count++] = relative_spread(point);
    }
    sort_doubles(spreads, count);
    return sorted_quantile(spreads, count, 0.5);
}

/* Squared, relative to the median. */
static double median_variance(const json_t *point, double typical)
{
    double deviation = fmax(relative_spread(point), typical) / 1.349;
    double runs = fmax(number_of(point, "runs"), 1);
    return 1.2533 * 1.2533 * deviation * deviation / runs;
}

/* How the machine as a whole has changed from one bench to the other, as the settings of one backend tell. */
struct drift {
    bool known;
    double log_ratio, variance; /* of times */
};

enum { VULKAN, CPU, BACKENDS };

struct comparing {
    const json_t *old_scene, *new_scene;
    bool times; /* can be compared */
    double old_typical, new_typical;
    struct drift drifts[BACKENDS];
    size_t compared, worse, better;
    FILE *stream;
};

static void print_change(const struct comparing *comparing, const json_t *point, const char *what,
                         double old_value, double new_value, const char *unit)
{
    const char *options = json_text_at(point, "options");
    fprintf(comparing->stream, "%s: %s: %s: %.3g%s, was %.3g%s\n",
            json_text_at(comparing->new_scene, "scene"), *options ? options : "as the scene says", what,
            new_value, unit, old_value, unit);
}

static int backend_of(const json_t *point)
{
    return strcmp(json_text_at(point, "backend"), "cpu") == 0 ? CPU : VULKAN;
}

static double log_ratio(const json_t *old, const json_t *new)
{
    return log(number_of(new, "time_ms") / number_of(old, "time_ms"));
}

/* The median over the settings of a backend, and its variance. */
static struct drift find_drift(const struct comparing *comparing, int backend)
{
    double ratios[MAX_POINTS], sum = 0, squares = 0;
    size_t count = 0, i;
    const json_t *point;
    json_array_foreach(json_object_get(comparing->new_scene, "points"), i, point)
    {
        const json_t *old = find_point(comparing->old_scene, point);
        double ratio = old && backend_of(point) == backend ? log_ratio(old, point) : NAN;
        if (!isfinite(ratio) || count == MAX_POINTS)
            continue;
        ratios[count++] = ratio;
        sum += ratio;
        squares += ratio * ratio;
    }
    if (count < 2)
        return (struct drift){.known = false};
    sort_doubles(ratios, count);
    double n = (double)count, variance = fmax(squares - sum * sum / n, 0) / (n - 1);
    return (struct drift){true, sorted_quantile(ratios, count, 0.5), 1.2533 * 1.2533 * variance / n};
}

static bool is_beyond(double change, double variance)
{
    return fabs(change) > fmax(log1p(least_change), standard_errors * sqrt(variance));
}

static void compare_times(struct comparing *comparing, const json_t *old, const json_t *new)
{
    double change = log_ratio(old, new);
    double variance =
        median_variance(old, comparing->old_typical) + median_variance(new, comparing->new_typical);
    const struct drift *control = &comparing->drifts[backend_of(new) == CPU ? VULKAN : CPU];
    double own = change - control->log_ratio;
    if (!is_beyond(change, variance) ||
        (control->known && (own * change < 0 || !is_beyond(own, variance + control->variance))))
        return;
    print_change(comparing, new, change > 0 ? "SLOWER" : "faster", number_of(old, "time_ms"),
                 number_of(new, "time_ms"), " ms");
    comparing->worse += change > 0;
    comparing->better += change < 0;
}

static void compare_errors(struct comparing *comparing, const json_t *old, const json_t *new)
{
    static const struct {
        const char *key, *name;
    } measures[] = {{"rmse", "RMSE"}, {"max", "largest error"}};
    const json_t *old_error = json_object_get(old, "error"), *new_error = json_object_get(new, "error");
    bool sampled =
        number_of(new, "samples") > 1 || json_is_true(json_object_get(comparing->new_scene, "sampled"));
    double noise = sampled ? standard_errors * hypot(number_of(old_error, "rmse_uncertainty"),
                                                     number_of(new_error, "rmse_uncertainty"))
                           : 0;
    for (size_t i = 0; i < (sampled ? 1 : 2); ++i) {
        double before = number_of(old_error, measures[i].key), after = number_of(new_error, measures[i].key);
        if (before == after || !(fabs(after - before) > fmax(noise, printing_error * before)))
            continue;
        char what[64];
        snprintf(what, sizeof what, "%s, %s", after > before ? "LESS ACCURATE" : "more accurate",
                 measures[i].name);
        print_change(comparing, new, what, before, after, "");
        comparing->worse += after > before;
        comparing->better += after < before;
        return;
    }
}

static bool same_truth(const json_t *a, const json_t *b, bool filtered)
{
    return same_text(a, b, filtered ? "truth_samples" : "truth") &&
           number_of(a, "width") == number_of(b, "width") && number_of(a, "height") == number_of(b, "height");
}

static void compare_scenes(struct comparing *comparing)
{
    const json_t *point;
    size_t i;
    comparing->old_typical = typical_spread(comparing->old_scene);
    comparing->new_typical = typical_spread(comparing->new_scene);
    for (int backend = 0; backend < BACKENDS; ++backend)
        comparing->drifts[backend] = find_drift(comparing, backend);
    const char *name = json_text_at(comparing->new_scene, "scene");
    bool same_size = number_of(comparing->old_scene, "width") == number_of(comparing->new_scene, "width") &&
                     number_of(comparing->old_scene, "height") == number_of(comparing->new_scene, "height");
    if (!same_size)
        fprintf(comparing->stream, "%s: another size: not compared\n", name);
    for (int filtered = 0; filtered < 2 && same_size; ++filtered)
        if (!same_truth(comparing->old_scene, comparing->new_scene, filtered))
            fprintf(comparing->stream, "%s: another truth%s: errors are not compared\n", name,
                    filtered ? " for samples" : "");
    json_array_foreach(json_object_get(comparing->new_scene, "points"), i, point)
    {
        const json_t *old = same_size ? find_point(comparing->old_scene, point) : NULL;
        bool filtered = strcmp(json_text_at(point, "family"), "samples") == 0;
        if (!old)
            continue;
        ++comparing->compared;
        if (comparing->times)
            compare_times(comparing, old, point);
        if (same_truth(comparing->old_scene, comparing->new_scene, filtered))
            compare_errors(comparing, old, point);
    }
}

/* Says where the bench ran elsewhere, and returns whether it did not. */
static bool same_machine(const json_t *old, const json_t *new, FILE *stream)
{
    static const char *const keys[] = {"processor", "cores", "device", "driver"};
    const json_t *old_machine = json_object_get(old, "machine"),
                 *new_machine = json_object_get(new, "machine");
    bool same = true;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i) {
        const json_t *before = json_object_get(old_machine, keys[i]),
                     *now = json_object_get(new_machine, keys[i]);
        if (json_equal(before, now) || (!before && !now))
            continue;
        if (json_is_integer(before) && json_is_integer(now))
            fprintf(stream, "another machine: %s %lld, was %lld\n", keys[i],
                    (long long)json_integer_value(now), (long long)json_integer_value(before));
        else
            fprintf(stream, "another machine: %s %s, was %s\n", keys[i],
                    now ? json_text_at(new_machine, keys[i]) : "none",
                    before ? json_text_at(old_machine, keys[i]) : "none");
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
    comparing.times = same_machine(old, new, stream);
    json_array_foreach(json_object_get(new, "scenes"), i, scene)
    {
        comparing.old_scene = find_scene(old, scene);
        comparing.new_scene = scene;
        if (comparing.old_scene)
            compare_scenes(&comparing);
        else
            fprintf(stream, "%s: not measured before\n", json_text_at(scene, "scene"));
    }
    if (comparing.compared == 0) {
        log_error("--compare: the earlier bench has no scene, size and setting in common with this one");
        return STATUS_REFUSED;
    }
    fprintf(stream, "compared %zu settings: %zu became worse, %zu better beyond noise\n", comparing.compared,
            comparing.worse, comparing.better);
    return comparing.worse > 0 ? STATUS_DIFFERS : STATUS_DONE;
}
