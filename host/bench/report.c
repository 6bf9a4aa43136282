#include "bench/report.h"

#include <math.h>
#include <string.h>

#include "base/output_file.h"
#include "bench/chart_convergence.h"
#include "bench/chart_speed.h"
#include "bench/json_value.h"
#include "bench/markup.h"
#include "bench/report_tables.h"
#include "report_css.h"

static void write_date(const char *date, FILE *out)
{
    /* 2026-01-31T12:00:00Z */
    if (strlen(date) == 20 && date[10] == 'T' && date[19] == 'Z') {
        char shorter[32];
        snprintf(shorter, sizeof shorter, "%.10s %.5s UTC", date, date + 11);
        markup_text(out, shorter);
    } else {
        markup_text(out, date);
    }
}

static void write_head(const json_t *document, FILE *out)
{
    fputs(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n"
        "<meta http-equiv=\"Content-Security-Policy\" "
        "content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>Speed against error</title>\n<style>\n",
        out);
    fwrite(report_css, 1, sizeof report_css, out);
    fputs("</style>\n</head>\n<body>\n<header>\n<h1>Speed against error</h1>\n<p class=\"quiet\">", out);
    markup_text(out, json_text_at(document, "program"));
    fputc(' ', out);
    markup_text(out, json_text_at(document, "version"));
    fputs(", ", out);
    write_date(json_text_at(document, "date"), out);
    if (json_is_true(json_object_get(document, "quick")))
        fputs(", a quick run with few settings and few repetitions", out);
    fputs("</p>\n<pre>", out);
    markup_text(out, json_text_at(document, "command"));
    fputs("</pre>\n</header>\n", out);
}

static void write_picture(const json_t *scene, const char *key, const char *caption, FILE *out)
{
    const char *base64 = json_text_at(json_object_get(scene, "pictures"), key);
    if (!*base64)
        return;
    fprintf(out, "<figure>\n<img width=\"%.0f\" height=\"%.0f\" alt=\"%s\" src=\"data:image/png;base64,",
            json_number_at(scene, "width"), json_number_at(scene, "height"), caption);
    markup_text(out, base64);
    fprintf(out, "\"/>\n<figcaption>%s</figcaption>\n</figure>\n", caption);
}

static void write_pictures(const json_t *scene, FILE *out)
{
    fputs("<div class=\"pictures\">\n", out);
    write_picture(scene, "render", "The picture", out);
    write_picture(scene, "heatmap", "Device against reference: black where the bits are the same", out);
    fputs("</div>\n", out);
}

/* Both sizes; the style sheet shows one. */
static enum status write_speed_chart(const json_t *scene, size_t index, FILE *out)
{
    char wide[32], narrow[32], rows[32];
    snprintf(wide, sizeof wide, "s%zu-wide-", index);
    snprintf(narrow, sizeof narrow, "s%zu-narrow-", index);
    snprintf(rows, sizeof rows, "s%zu-p", index);
    const struct chart_frame frames[] = {
        {.width = 1040, .height = 600, .font = 15, .left = 62, .right = 24, .bottom = 58, .id = wide},
        {.width = 370,
         .height = 480,
         .font = 13,
         .left = 50,
         .right = 14,
         .bottom = 52,
         .narrow = true,
         .id = narrow},
    };
    fputs("<h3>Speed against error</h3>\n<figure class=\"chart\">\n", out);
    enum status status = chart_speed(scene, &frames[0], rows, out);
    if (status == STATUS_DONE)
        status = chart_speed(scene, &frames[1], rows, out);
    fputs("<figcaption>A point is one setting: the median time of a picture, with quartiles, against the "
          "error. "
          "Left and below is better. Nothing measured beats a point of the Pareto front in both. An error of "
          "exactly 0 stands at the left edge. Each point shows on hover what it is, and leads to its row in "
          "the "
          "table. Errors are against ",
          out);
    markup_text(out, json_text_at(scene, "truth"));
    const char *truth_samples = json_text_at(scene, "truth_samples");
    if (*truth_samples) {
        fputs("; those of <code>--samples</code> against ", out);
        markup_text(out, truth_samples);
        fputs(", with a front of their own", out);
    }
    fputs(".</figcaption>\n</figure>\n", out);
    return status;
}

static enum status write_convergence(const json_t *scene, size_t index, FILE *out)
{
    const json_t *entries = json_object_get(scene, "convergence");
    enum status status = STATUS_DONE;
    if (json_array_size(entries) == 0)
        return status;
    fputs("<h3>Convergence</h3>\n<div class=\"charts\">\n", out);
    for (size_t i = 0; i < json_array_size(entries) && status == STATUS_DONE; i++) {
        const json_t *entry = json_array_get(entries, i);
        char id[48];
        snprintf(id, sizeof id, "s%zu-c%zu-", index, i);
        const struct chart_frame frame = {
            .width = 400, .height = 350, .font = 15, .left = 58, .right = 18, .bottom = 58, .id = id};
        fputs("<figure class=\"chart\">\n", out);
        status = chart_convergence(entry, &frame, out);
        fputs("<figcaption><code>--", out);
        markup_text(out, json_text_at(entry, "family"));
        fputs("</code>: ", out);
        double slope = json_number_at(entry, "slope");
        if (isfinite(slope))
            fprintf(out, "the error falls as N<sup>%s%.2f</sup>, fitted from %.0f to %.0f samples",
                    slope < 0.0 ? "−" : "", fabs(slope), json_number_at(entry, "slope_from"),
                    json_number_at(entry, "slope_to"));
        else
            fputs("too few points to fit a slope to", out);
        fputs("</figcaption>\n</figure>\n", out);
    }
    fputs("</div>\n", out);
    return status;
}

static enum status write_scene(const json_t *scene, size_t index, FILE *out)
{
    fprintf(out, "<section id=\"s%zu\">\n<h2>", index);
    markup_text(out, json_text_at(scene, "scene"));
    fprintf(
        out,
        "</h2>\n<p class=\"quiet\">%.0f × %.0f pixels; bounces: %.0f, light samples: %.0f, samples a pixel: "
        "%.0f</p>\n",
        json_number_at(scene, "width"), json_number_at(scene, "height"), json_number_at(scene, "max_bounces"),
        json_number_at(scene, "light_samples"), json_number_at(scene, "samples"));
    write_pictures(scene, out);
    enum status status = STATUS_DONE;
    if (json_array_size(json_object_get(scene, "points")) > 0) {
        report_recommendations(scene, out);
        status = write_speed_chart(scene, index, out);
        report_points(scene, index, out);
    }
    if (status == STATUS_DONE)
        status = write_convergence(scene, index, out);
    fputs("</section>\n", out);
    return status;
}

static enum status write_page(const json_t *document, FILE *out)
{
    const json_t *scenes = json_object_get(document, "scenes");
    enum status status = STATUS_DONE;
    write_head(document, out);
    report_agreement(scenes, out);
    for (size_t i = 0; i < json_array_size(scenes) && status == STATUS_DONE; i++)
        status = write_scene(json_array_get(scenes, i), i, out);
    report_machine(json_object_get(document, "machine"), out);
    fputs("</body>\n</html>\n", out);
    return status;
}

enum status report_write(const json_t *document, const char *path)
{
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    status = write_page(document, file.stream);
    if (status == STATUS_DONE)
        return output_file_commit(&file);
    output_file_abandon(&file);
    return status;
}

enum status chart_write(const json_t *scene, const char *path)
{
    static const struct chart_frame frame = {.width = 960,
                                             .height = 640,
                                             .font = 15,
                                             .left = 62,
                                             .right = 24,
                                             .bottom = 58,
                                             .alone = true,
                                             .id = ""};
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    fputs("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n", file.stream);
    status = chart_speed(scene, &frame, "", file.stream);
    if (status == STATUS_DONE)
        return output_file_commit(&file);
    output_file_abandon(&file);
    return status;
}
