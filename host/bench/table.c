#include <math.h>
#include <string.h>

#include "base/output_file.h"
#include "bench/document.h"

/* The points against the one truth or the other. */
static void print_points(const json_t *scene, bool filtered, FILE *stream)
{
    static const char as_it_is[] = "(as the scene says)";
    const json_t *points = json_object_get(scene, "points"), *point;
    size_t i;
    int width = (int)strlen(as_it_is), count = 0;
    json_array_foreach(points, i, point)
    {
        int length = (int)strlen(bench_text(point, "options"));
        width = length > width ? length : width;
        count += bench_is_filtered(point) == filtered;
    }
    if (count == 0)
        return;
    fprintf(stream, "\nagainst %s\n", bench_text(scene, filtered ? "truth_samples" : "truth"));
    fprintf(stream, "  %-*s %9s %7s %8s  %8s %8s %8s %8s %8s %8s\n", width, "", "time", "+-", "Mrays/s",
            "max", "RMSE", "99.9 %", "relative", "99.9 %", "8-bit");
    json_array_foreach(points, i, point)
    {
        const json_t *error = json_object_get(point, "error");
        const char *options = bench_text(point, "options");
        if (bench_is_filtered(point) == filtered)
            fprintf(stream, "%c %-*s %9.2f %7.2f %8.1f  %8.2g %8.2g %8.2g %8.2g %8.2g %8.0f\n",
                    json_is_true(json_object_get(point, "pareto")) ? '*' : ' ', width,
                    *options ? options : as_it_is, bench_number(point, "time_ms"), bench_spread_ms(point) / 2,
                    bench_number(point, "rays_per_second") * 1e-6, bench_number(error, "max"),
                    bench_number(error, "rmse"), bench_number(error, "absolute_999"),
                    bench_number(error, "relative_median"), bench_number(error, "relative_999"),
                    bench_number(error, "pixels_off_8bit"));
    }
}

static void print_conclusions(const json_t *scene, FILE *stream)
{
    const json_t *line;
    size_t i;
    json_array_foreach(json_object_get(scene, "convergence"), i, line)
    {
        double slope = bench_number(line, "slope");
        if (isfinite(slope))
            fprintf(stream, "RMSE falls as N^%.2f with %s from %.0f to %.0f\n", slope,
                    bench_text(line, "family"), bench_number(line, "slope_from"),
                    bench_number(line, "slope_to"));
    }
    fputs("fastest settings with 99.9 % of the pixels within an error:\n", stream);
    json_array_foreach(json_object_get(scene, "recommendations"), i, line)
    {
        const char *options = json_string_value(json_object_get(line, "options"));
        fprintf(stream, "  %-6g ", bench_number(line, "error"));
        if (options)
            fprintf(stream, "%s (%.3g ms)\n", *options ? options : "as the scene says",
                    bench_number(line, "time_ms"));
        else
            fputs("none measured\n", stream);
    }
}

void bench_print_scene(const json_t *scene, FILE *stream)
{
    fprintf(stream, "%s: %.0fx%.0f; times in ms: median and half the distance of the quartiles; errors in\n",
            bench_text(scene, "scene"), bench_number(scene, "width"), bench_number(scene, "height"));
    fputs("linear radiance: largest, RMSE and of 99.9 % of the pixels; relative: of 50 % and 99.9 %; 8-bit:\n"
          "pixels off by more than a step. * marks what nothing beats in both time and the error of 99.9 %\n",
          stream);
    print_points(scene, false, stream);
    print_points(scene, true, stream);
    fputc('\n', stream);
    print_conclusions(scene, stream);
}

/* A field: text in quotes, numbers as they are, null empty. */
static void put_field(FILE *stream, const json_t *value)
{
    if (json_is_string(value)) {
        fputc('"', stream);
        for (const char *text = json_string_value(value); *text; ++text)
            fputs(*text == '"' ? "\"\"" : (char[]){*text, '\0'}, stream);
        fputc('"', stream);
    } else if (json_is_integer(value)) {
        fprintf(stream, "%lld", (long long)json_integer_value(value));
    } else if (json_is_real(value)) {
        fprintf(stream, "%.9g", json_real_value(value));
    } else if (json_is_boolean(value)) {
        fprintf(stream, "%d", json_is_true(value));
    }
}

/* The fields of a value, or with names_only their names: those of an object's or array's elements are its own
 * and theirs, as in error_rmse. Each field but the first of a line, which is the scene, has a comma before
 * it. */
static void put_fields(FILE *stream, const char *name, json_t *value, bool names_only)
{
    char longer[100];
    const char *key;
    json_t *element;
    size_t i;
    json_object_foreach(value, key, element)
    {
        snprintf(longer, sizeof longer, "%s%s%s", name, *name ? "_" : "", key);
        put_fields(stream, longer, element, names_only);
    }
    json_array_foreach(value, i, element)
    {
        snprintf(longer, sizeof longer, "%s_%zu", name, i + 1);
        put_fields(stream, longer, element, names_only);
    }
    if (json_is_object(value) || json_is_array(value))
        return;
    fprintf(stream, ",%s", names_only ? name : "");
    if (!names_only)
        put_field(stream, value);
}

enum status bench_csv_write(const json_t *document, const char *path)
{
    json_t *scene, *point;
    size_t s, p;
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    json_array_foreach(json_object_get(document, "scenes"), s, scene)
        json_array_foreach(json_object_get(scene, "points"), p, point)
    {
        if (s == 0 && p == 0) {
            fputs("scene", file.stream);
            put_fields(file.stream, "", point, true);
            fputs("\r\n", file.stream);
        }
        put_field(file.stream, json_object_get(scene, "scene"));
        put_fields(file.stream, "", point, false);
        fputs("\r\n", file.stream);
    }
    return output_file_commit(&file);
}
