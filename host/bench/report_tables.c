#include "bench/report_tables.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "bench/json_value.h"
#include "bench/markup.h"

static void write_cell(FILE *out, const char *text)
{
    fprintf(out, "<td>%s</td>", text);
}

static void write_number(FILE *out, double number)
{
    char buffer[MARKUP_NUMBER_SIZE];
    write_cell(out, markup_number(number, buffer));
}

static void write_count(FILE *out, double count)
{
    char buffer[MARKUP_NUMBER_SIZE];
    write_cell(out, markup_count(count, buffer));
}

/* The error at a key; of an object that is not there, a dash. */
static void write_error(FILE *out, const json_t *errors, const char *key)
{
    char buffer[MARKUP_NUMBER_SIZE];
    write_cell(out, json_is_object(errors) ? markup_error(json_number_at(errors, key), buffer) : "–");
}

static void write_agreement_row(const json_t *scene, size_t index, FILE *out)
{
    const json_t *agreement = json_object_get(scene, "agreement"),
                 *rounding = json_object_get(scene, "rounding");
    fprintf(out, "<tr><th scope=\"row\"><a href=\"#s%zu\">", index);
    markup_text(out, json_text_at(scene, "scene"));
    fputs("</a></th>", out);
    write_count(out, json_number_at(agreement, "pixels"));
    write_count(out, json_number_at(agreement, "differing_pixels"));
    write_error(out, rounding, "median");
    write_error(out, rounding, "p99");
    write_error(out, rounding, "p9999");
    write_error(out, rounding, "max");
    write_count(out, json_number_at(rounding, "pixels"));
    write_count(out, json_number_at(rounding, "unexplained"));
    fputs("<td>", out);
    markup_text(out, json_is_object(rounding) ? json_text_at(rounding, "against") : "–");
    fputs("</td></tr>\n", out);
}

void report_agreement(const json_t *scenes, FILE *out)
{
    fputs("<section>\n<h2>Device against reference</h2>\n<div class=\"scroll\">\n<table>\n<thead>\n"
          "<tr><th scope=\"col\" rowspan=\"2\">scene</th><th scope=\"colgroup\" colspan=\"2\">pixels</th>"
          "<th scope=\"colgroup\" colspan=\"4\">rounding error, relative</th>"
          "<th scope=\"colgroup\" colspan=\"3\">judged</th></tr>\n"
          "<tr><th scope=\"col\">all</th><th scope=\"col\">differing</th><th scope=\"col\">median</th>"
          "<th scope=\"col\">99 %</th><th scope=\"col\">99.99 %</th><th scope=\"col\">max</th>"
          "<th scope=\"col\">pixels</th><th scope=\"col\">unexplained</th>"
          "<th scope=\"col\">against</th></tr>\n</thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < json_array_size(scenes); i++)
        write_agreement_row(json_array_get(scenes, i), i, out);
    fputs("</tbody>\n</table>\n</div>\n<p class=\"quiet\">"
          "Differing: pixels in which device and reference, both in float, do not have the same bits. "
          "Unexplained: pixels farther from the reference in the precision named last "
          "than the analysis of rounding allows.</p>\n</section>\n",
          out);
}

void report_recommendations(const json_t *scene, FILE *out)
{
    const json_t *recommendations = json_object_get(scene, "recommendations");
    if (json_array_size(recommendations) == 0)
        return;
    fputs("<h3>Fastest settings with 99.9 % of the pixels within an error</h3>\n"
          "<div class=\"scroll\">\n<table>\n<thead><tr>"
          "<th scope=\"col\">error at most</th><th scope=\"col\">time, ms</th>"
          "<th scope=\"col\" class=\"text\">options</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < json_array_size(recommendations); i++) {
        const json_t *recommendation = json_array_get(recommendations, i);
        const json_t *options = json_object_get(recommendation, "options");
        double power = log10(json_number_at(recommendation, "error"));
        fprintf(out, "<tr><th scope=\"row\">10<sup>%s%.4g</sup></th>", power < 0.0 ? "−" : "", fabs(power));
        write_number(out, json_number_at(recommendation, "time_ms"));
        fputs("<td class=\"text\">", out);
        if (!json_is_string(options)) {
            fputs("none measured", out);
        } else if (json_string_length(options) == 0) {
            fputs("the defaults", out);
        } else {
            fputs("<code>", out);
            markup_text(out, json_string_value(options));
            fputs("</code>", out);
        }
        fputs("</td></tr>\n", out);
    }
    fputs("</tbody>\n</table>\n</div>\n", out);
}

static bool has_energy(const json_t *points)
{
    for (size_t i = 0; i < json_array_size(points); i++)
        if (json_is_number(json_object_get(json_array_get(points, i), "energy_joules")))
            return true;
    return false;
}

static void write_points_head(bool energy, FILE *out)
{
    fputs("<thead>\n<tr><th scope=\"col\" rowspan=\"2\">settings</th>"
          "<th scope=\"colgroup\" colspan=\"5\">time, ms</th>"
          "<th scope=\"colgroup\" colspan=\"6\">error</th>"
          "<th scope=\"colgroup\" colspan=\"4\">rays, millions</th>",
          out);
    if (energy)
        fputs("<th scope=\"col\" rowspan=\"2\">energy,<br/>J</th>", out);
    fputs("<th scope=\"col\" rowspan=\"2\" class=\"text\">options</th></tr>\n", out);
    static const char *const columns[] = {
        "median",
        "quartiles",
        "runs",
        "first",
        "setup",
        "RMSE",
        "max",
        "99.9 %",
        "relative,<br/>median",
        "relative,<br/>99.9 %",
        "pixels<br/>off",
        "primary",
        "secondary",
        "shadow",
        "a second",
    };
    fputs("<tr>", out);
    for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++)
        fprintf(out, "<th scope=\"col\">%s</th>", columns[i]);
    fputs("</tr>\n</thead>\n", out);
}

static void write_label(const json_t *point, FILE *out)
{
    bool pareto = json_is_true(json_object_get(point, "pareto"));
    fprintf(out, "<th scope=\"row\">%s", pareto ? "<span class=\"front\">●</span> " : "");
    markup_text(out, json_text_at(point, "label"));
    fputs("</th>", out);
}

static void write_quartiles(const json_t *point, FILE *out)
{
    const json_t *quartiles = json_object_get(point, "time_quartiles_ms");
    char first[MARKUP_NUMBER_SIZE], third[MARKUP_NUMBER_SIZE];
    if (json_array_size(quartiles) != 2) {
        write_cell(out, "–");
        return;
    }
    fprintf(out, "<td>%s–%s</td>", markup_number(json_number_value(json_array_get(quartiles, 0)), first),
            markup_number(json_number_value(json_array_get(quartiles, 1)), third));
}

static void write_point(const json_t *point, bool energy, FILE *out)
{
    const json_t *error = json_object_get(point, "error"), *rays = json_object_get(point, "rays");
    write_label(point, out);
    write_number(out, json_number_at(point, "time_ms"));
    write_quartiles(point, out);
    write_count(out, json_number_at(point, "runs"));
    write_number(out, json_number_at(point, "first_ms"));
    write_number(out, json_number_at(point, "setup_ms"));
    write_error(out, error, "rmse");
    write_error(out, error, "max");
    write_error(out, error, "absolute_999");
    write_error(out, error, "relative_median");
    write_error(out, error, "relative_999");
    write_count(out, json_number_at(error, "pixels_off_8bit"));
    write_number(out, 1e-6 * json_number_at(rays, "primary"));
    write_number(out, 1e-6 * json_number_at(rays, "secondary"));
    write_number(out, 1e-6 * json_number_at(rays, "shadow"));
    write_number(out, 1e-6 * json_number_at(point, "rays_per_second"));
    if (energy)
        write_number(out, json_number_at(point, "energy_joules"));
    fputs("<td class=\"text\"><code>", out);
    markup_text(out, json_text_at(point, "options"));
    fputs("</code></td></tr>\n", out);
}

void report_points(const json_t *scene, size_t index, FILE *out)
{
    const json_t *points = json_object_get(scene, "points");
    bool energy = has_energy(points);
    const char *family = "";
    fputs("<h3>All settings measured</h3>\n<div class=\"scroll\">\n<table class=\"points\">\n", out);
    write_points_head(energy, out);
    fputs("<tbody>\n", out);
    for (size_t i = 0; i < json_array_size(points); i++) {
        const json_t *point = json_array_get(points, i);
        bool begins = strcmp(json_text_at(point, "family"), family) != 0;
        family = json_text_at(point, "family");
        fprintf(out, "<tr id=\"s%zu-p%zu\"%s>", index, i, begins && i > 0 ? " class=\"begins\"" : "");
        write_point(point, energy, out);
    }
    fputs("</tbody>\n</table>\n</div>\n<p class=\"quiet\">"
          "<span class=\"front\">●</span> on the Pareto front. Time: warm runs on the device's own clock "
          "where it "
          "has one; first: the first run, which compiles; setup: what precedes it. Error: linear radiance; "
          "99.9 %: of the pixels have at most this; pixels off: by more than one step of an 8-bit "
          "picture.</p>\n",
          out);
}

void report_machine(const json_t *machine, FILE *out)
{
    static const struct {
        const char *key, *name;
    } strings[] = {{"processor", "processor"}, {"os", "system"},     {"device", "device"},
                   {"driver", "driver"},       {"vulkan", "Vulkan"}, {"compiler", "compiler"}};
    char number[MARKUP_NUMBER_SIZE];
    fputs("<section>\n<h2>Machine</h2>\n<dl>\n", out);
    for (size_t i = 0; i < sizeof strings / sizeof strings[0]; i++) {
        const char *text = json_text_at(machine, strings[i].key);
        if (!*text)
            continue;
        fprintf(out, "<dt>%s</dt><dd>", strings[i].name);
        markup_text(out, text);
        fputs("</dd>\n", out);
    }
    fprintf(out, "<dt>cores</dt><dd>%s</dd>\n", markup_count(json_number_at(machine, "cores"), number));
    fprintf(out, "<dt>memory</dt><dd>%s GiB</dd>\n",
            markup_number(json_number_at(machine, "memory_gib"), number));
    fputs("</dl>\n</section>\n", out);
}
