#include <math.h>
#include <string.h>

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
