#include "bench/table.h"

#include <math.h>
#include <string.h>

#include "base/output_file.h"
#include "bench/json_value.h"

/* Null stands for what is not finite. */
static double number_of(const json_t *object, const char *key)
{
    double value = json_number_at(object, key);
    return isnan(value) ? INFINITY : value;
}

static void print_point(const json_t *point, int options_width, FILE *stream)
{
    const json_t *error = json_object_get(point, "error"), *quartiles;
    const char *options = json_text_at(point, "options");
    quartiles = json_object_get(point, "time_quartiles_ms");
    double spread =
        (json_number_value(json_array_get(quartiles, 1)) - json_number_value(json_array_get(quartiles, 0))) /
        2;
    fprintf(stream, "%c %-*s %9.2f %7.2f %8.1f  %8.2g %8.2g %8.2g %8.2g %8.2g %8lld\n",
            json_is_true(json_object_get(point, "pareto")) ? '*' : ' ', options_width,
            *options ? options : "(as the scene says)", number_of(point, "time_ms"), spread,
            number_of(point, "rays_per_second") * 1e-6, number_of(error, "max"), number_of(error, "rmse"),
            number_of(error, "absolute_999"), number_of(error, "relative_median"),
            number_of(error, "relative_999"),
            (long long)json_integer_value(json_object_get(error, "pixels_off_8bit")));
}

static void print_points(const json_t *scene, bool filtered, FILE *stream)
{
    const json_t *points = json_object_get(scene, "points"), *point;
    size_t i;
    int width = (int)strlen("(as the scene says)"), count = 0;
    json_array_foreach(points, i, point)
    {
        int length = (int)strlen(json_text_at(point, "options"));
        width = length > width ? length : width;
        count += (strcmp(json_text_at(point, "family"), "samples") == 0) == filtered;
    }
    if (count == 0)
        return;
    fprintf(stream, "\nagainst %s\n", json_text_at(scene, filtered ? "truth_samples" : "truth"));
    fprintf(stream, "  %-*s %9s %7s %8s  %8s %8s %8s %8s %8s %8s\n", width, "", "time", "+-", "Mrays/s",
            "max", "RMSE", "99.9 %", "relative", "99.9 %", "8-bit");
    json_array_foreach(points, i, point)
    {
        if ((strcmp(json_text_at(point, "family"), "samples") == 0) == filtered)
            print_point(point, width, stream);
    }
}

static void print_convergence(const json_t *scene, FILE *stream)
{
    const json_t *family;
    size_t i;
    json_array_foreach(json_object_get(scene, "convergence"), i, family)
    {
        double slope = number_of(family, "slope");
        if (isfinite(slope))
            fprintf(stream, "RMSE falls as N^%.2f with %s from %lld to %lld\n", slope,
                    json_text_at(family, "family"),
                    (long long)json_integer_value(json_object_get(family, "slope_from")),
                    (long long)json_integer_value(json_object_get(family, "slope_to")));
    }
}

static void print_recommendations(const json_t *scene, FILE *stream)
{
    const json_t *line;
    size_t i;
    fputs("fastest settings with 99.9 % of the pixels within an error:\n", stream);
    json_array_foreach(json_object_get(scene, "recommendations"), i, line)
    {
        const char *options = json_string_value(json_object_get(line, "options"));
        fprintf(stream, "  %-6g ", number_of(line, "error"));
        if (options)
            fprintf(stream, "%s (%.3g ms)\n", *options ? options : "as the scene says",
                    number_of(line, "time_ms"));
        else
            fputs("none measured\n", stream);
    }
}

void bench_print_scene(const json_t *scene, FILE *stream)
{
    const json_t *agreement = json_object_get(scene, "agreement"),
                 *rounding = json_object_get(scene, "rounding");
    fprintf(stream, "%s: %lldx%lld; times in ms: median and half the distance of the quartiles; errors in\n",
            json_text_at(scene, "scene"), (long long)json_integer_value(json_object_get(scene, "width")),
            (long long)json_integer_value(json_object_get(scene, "height")));
    fputs("linear radiance: largest, RMSE and of 99.9 % of the pixels; relative: of 50 % and 99.9 %; 8-bit:\n"
          "pixels off by more than a step. * marks what nothing beats in both time and the error of 99.9 %\n",
          stream);
    print_points(scene, false, stream);
    print_points(scene, true, stream);
    fputc('\n', stream);
    print_convergence(scene, stream);
    if (json_is_object(agreement))
        fprintf(stream, "device and reference: %lld of %lld pixels differ\n",
                (long long)json_integer_value(json_object_get(agreement, "differing_pixels")),
                (long long)json_integer_value(json_object_get(agreement, "pixels")));
    if (json_is_object(rounding))
        fprintf(stream,
                "rounding: relative error median %.2g, 99 %% %.2g, max %.2g; %lld pixels unexplained\n",
                number_of(rounding, "median"), number_of(rounding, "p99"), number_of(rounding, "max"),
                (long long)json_integer_value(json_object_get(rounding, "unexplained")));
    print_recommendations(scene, stream);
}

/* A field: text in quotes, numbers as they are, null empty. */
static void write_field(struct output_file *file, const json_t *value, bool last)
{
    char number[64] = "";
    if (json_is_string(value)) {
        output_file_write(file, "\"", 1);
        for (const char *text = json_string_value(value); *text; ++text)
            output_file_write(file, *text == '"' ? "\"\"" : text, *text == '"' ? 2 : 1);
        output_file_write(file, "\"", 1);
    } else if (json_is_integer(value)) {
        snprintf(number, sizeof number, "%lld", (long long)json_integer_value(value));
    } else if (json_is_real(value)) {
        snprintf(number, sizeof number, "%.9g", json_real_value(value));
    } else if (json_is_boolean(value)) {
        snprintf(number, sizeof number, "%d", json_is_true(value));
    }
    output_file_write(file, number, strlen(number));
    output_file_write(file, last ? "\r\n" : ",", last ? 2 : 1);
}

/* What stands at a path of keys, separated by dots; a digit is an index. */
static const json_t *value_at(const json_t *value, const char *path)
{
    while (value && *path) {
        char key[32];
        size_t length = strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)length, path);
        value = json_is_array(value) ? json_array_get(value, (size_t)(key[0] - '0'))
                                     : json_object_get(value, key);
        path += length + (path[length] == '.');
    }
    return value;
}

enum status bench_csv_write(const json_t *document, const char *path)
{
    static const struct {
        const char *name, *path;
    } fields[] = {
        {"label", "label"},
        {"options", "options"},
        {"family", "family"},
        {"backend", "backend"},
        {"threads", "threads"},
        {"precision", "precision"},
        {"mode", "mode"},
        {"max_error", "max_error"},
        {"max_bounces", "max_bounces"},
        {"light_samples", "light_samples"},
        {"samples", "samples"},
        {"time_ms", "time_ms"},
        {"time_quartile_1_ms", "time_quartiles_ms.0"},
        {"time_quartile_3_ms", "time_quartiles_ms.1"},
        {"runs", "runs"},
        {"first_ms", "first_ms"},
        {"setup_ms", "setup_ms"},
        {"primary_rays", "rays.primary"},
        {"secondary_rays", "rays.secondary"},
        {"shadow_rays", "rays.shadow"},
        {"rays_per_second", "rays_per_second"},
        {"energy_joules", "energy_joules"},
        {"error_max", "error.max"},
        {"error_rmse", "error.rmse"},
        {"error_absolute_999", "error.absolute_999"},
        {"error_relative_median", "error.relative_median"},
        {"error_relative_999", "error.relative_999"},
        {"pixels_off_8bit", "error.pixels_off_8bit"},
        {"pareto", "pareto"},
    };
    const size_t field_count = sizeof fields / sizeof *fields;
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    output_file_write(&file, "scene", 5);
    for (size_t f = 0; f < field_count; ++f) {
        output_file_write(&file, ",", 1);
        output_file_write(&file, fields[f].name, strlen(fields[f].name));
    }
    output_file_write(&file, "\r\n", 2);
    const json_t *scene, *point;
    size_t s, p;
    json_array_foreach(json_object_get(document, "scenes"), s, scene)
        json_array_foreach(json_object_get(scene, "points"), p, point)
    {
        write_field(&file, json_object_get(scene, "scene"), false);
        for (size_t f = 0; f < field_count; ++f)
            write_field(&file, value_at(point, fields[f].path), f + 1 == field_count);
    }
    return output_file_commit(&file);
}
