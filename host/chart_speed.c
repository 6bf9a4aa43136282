#include "chart_speed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chart_labels.h"
#include "json_value.h"
#include "markup.h"

/* What the bench varies, and how it looks. The colours are Okabe and Ito's, which the colour-blind tell
 * apart; the shapes do without colour. The last takes what has another name. */
static const struct {
    const char *family, *title, *color;
    int shape; /* gnuplot's */
} families[] = {
    {"mode", "modes", "#222222", 7},
    {"max-error", "--max-error", "#0072b2", 5},
    {"bounces", "--max-bounces", "#d55e00", 9},
    {"light-samples", "--light-samples", "#009e73", 11},
    {"samples", "--samples", "#b4508c", 13},
    {"cpu", "CPU reference", "#777777", 6},
    {"", "others", "#222222", 2},
};
enum { FAMILY_COUNT = sizeof families / sizeof families[0] };

struct speed_point {
    const json_t *json;
    size_t row; /* in the scene's points */
    size_t family;
    double error, time_ms;
    bool pareto;
};

struct speed_chart {
    const struct chart_frame *frame;
    const char *row_prefix;
    struct speed_point *points; /* by error, then time */
    size_t count;
    struct log_axis x, y;
};

static int compare_points(const void *a, const void *b)
{
    const struct speed_point *p = a, *q = b;
    if (p->error != q->error)
        return p->error < q->error ? -1 : 1;
    return p->time_ms < q->time_ms ? -1 : p->time_ms > q->time_ms;
}

static bool has_own_truth(const struct speed_point *point)
{
    return strcmp(families[point->family].family, "samples") == 0;
}

static void read_points(const json_t *points, struct speed_chart *chart)
{
    for (size_t i = 0; i < json_array_size(points); i++) {
        const json_t *json = json_array_get(points, i);
        struct speed_point point = {
            .json = json,
            .row = i,
            .error = json_number_at(json_object_get(json, "error"), "rmse"),
            .time_ms = json_number_at(json, "time_ms"),
            .pareto = json_is_true(json_object_get(json, "pareto")),
        };
        if (!(point.time_ms > 0.0))
            continue; /* not measured */
        if (isnan(point.error))
            point.error = INFINITY;
        while (point.family < FAMILY_COUNT - 1 &&
               strcmp(json_text_at(json, "family"), families[point.family].family) != 0)
            point.family++;
        log_axis_include(&chart->x, point.error);
        log_axis_include(&chart->y, point.time_ms);
        chart->points[chart->count++] = point;
    }
    qsort(chart->points, chart->count, sizeof chart->points[0], compare_points);
    log_axis_finish(&chart->x);
    log_axis_finish(&chart->y);
}

static double quartile(const struct speed_point *point, size_t index)
{
    const json_t *value = json_array_get(json_object_get(point->json, "time_quartiles_ms"), index);
    double time_ms = json_number_value(value);
    return time_ms > 0.0 ? time_ms : point->time_ms;
}

/* The front as steps: at an error one can have the time of the last point before it. */
static bool write_front(const struct speed_chart *chart, bool own_truth, FILE *script)
{
    const struct speed_point *last = NULL;
    for (size_t i = 0; i < chart->count; i++) {
        const struct speed_point *point = &chart->points[i];
        if (!point->pareto || has_own_truth(point) != own_truth)
            continue;
        if (!last)
            fprintf(script, "$front%d << END\n", own_truth);
        fprintf(script, "%.9g %.9g\n", log_axis_place(&chart->x, point->error), point->time_ms);
        last = point;
    }
    if (last)
        fprintf(script, "%.9g %.9g\nEND\n", chart->x.to, last->time_ms);
    return last != NULL;
}

static bool write_family(const struct speed_chart *chart, size_t family, FILE *script)
{
    bool any = false;
    for (size_t i = 0; i < chart->count; i++) {
        const struct speed_point *point = &chart->points[i];
        if (point->family != family)
            continue;
        if (!any)
            fprintf(script, "$family%zu << END\n", family);
        fprintf(script, "%.9g %.9g %.9g %.9g\n", log_axis_place(&chart->x, point->error), point->time_ms,
                quartile(point, 0), quartile(point, 1));
        any = true;
    }
    if (any)
        fputs("END\n", script);
    return any;
}

static void write_script(const struct speed_chart *chart, FILE *script)
{
    const struct chart_frame *frame = chart->frame;
    bool present[FAMILY_COUNT];
    chart_frame_write(frame, &chart->x, &chart->y, script);
    fprintf(script,
            "set key at screen %.9g,%.9g left top horizontal Left reverse samplen 1.2 width 1 maxcols %d\n",
            8.0 / frame->width, 1.0 - (frame->alone ? 40.0 : 4.0) / frame->height, frame->narrow ? 2 : 8);
    fputs("set xlabel \"error (RMSE, linear radiance)\" textcolor rgb \"#333333\"\n", script);
    fprintf(script, "set label \"time, ms\" at screen %.9g,%.9g left textcolor rgb \"#333333\"\n",
            8.0 / frame->width, 1.0 - (frame->top - 1.1 * frame->font) / frame->height);
    bool fronts[2] = {write_front(chart, false, script), write_front(chart, true, script)};
    for (size_t family = 0; family < FAMILY_COUNT; family++)
        present[family] = write_family(chart, family, script);
    fputs("plot NaN notitle", script);
    if (fronts[0])
        fputs(", $front0 with steps lt 1 lw 1.5 lc rgb \"#999999\" title \"Pareto front\"", script);
    if (fronts[1])
        fputs(", $front1 with steps dt (6,4) lw 1.5 lc rgb \"#b4508c\" title \"front of --samples\"", script);
    for (size_t family = 0; family < FAMILY_COUNT; family++)
        if (present[family])
            fprintf(script, ", $family%zu with yerrorbars lt 1 pt %d ps %g lc rgb \"%s\" title \"%s\"",
                    family, families[family].shape, 0.055 * frame->font, families[family].color,
                    families[family].title);
    fputc('\n', script);
}

static void write_hover(const struct speed_chart *chart, const struct speed_point *point, FILE *overlay)
{
    char number[MARKUP_NUMBER_SIZE];
    const json_t *error = json_object_get(point->json, "error");
    if (!chart->frame->alone)
        fprintf(overlay, "<a href=\"#%s%zu\">", chart->row_prefix, point->row);
    fprintf(overlay, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" fill=\"none\" pointer-events=\"all\"><title>",
            log_axis_pixel(&chart->x, point->error), log_axis_pixel(&chart->y, point->time_ms),
            0.6 * chart->frame->font);
    markup_text(overlay, json_text_at(point->json, "label"));
    fprintf(overlay, "\n%s ms", markup_number(point->time_ms, number));
    fprintf(overlay, " (quartiles %s", markup_number(quartile(point, 0), number));
    fprintf(overlay, " to %s)\nRMSE ", markup_number(quartile(point, 1), number));
    fprintf(overlay, "%s, max error ", markup_error(point->error, number));
    fputs(markup_error(json_number_at(error, "max"), number), overlay);
    fputs(point->pareto ? "\non the Pareto front</title></circle>" : "</title></circle>", overlay);
    fputs(chart->frame->alone ? "\n" : "</a>\n", overlay);
}

static void write_title(const struct chart_frame *frame, const json_t *scene, FILE *overlay)
{
    fprintf(overlay, "<text x=\"8\" y=\"24\" font-family=\"sans-serif\" font-size=\"%g\" fill=\"#222222\">",
            1.2 * frame->font);
    markup_text(overlay, json_text_at(scene, "scene"));
    fprintf(overlay, ", %.0f × %.0f pixels</text>\n", json_number_at(scene, "width"),
            json_number_at(scene, "height"));
}

/* Labels on the front, then what to hover over, in which the front comes last and so is on top. */
static void write_overlay(const struct speed_chart *chart, struct box *taken, FILE *overlay)
{
    const struct chart_frame *frame = chart->frame;
    struct label_placer placer = {
        .field = {frame->left, frame->top, frame->width - 4.0, frame->height - frame->bottom},
        .font = 0.9 * frame->font,
        .taken = taken,
    };
    for (size_t i = 0; i < chart->count; i++)
        label_placer_avoid(&placer, log_axis_pixel(&chart->x, chart->points[i].error),
                           log_axis_pixel(&chart->y, chart->points[i].time_ms));
    for (size_t i = 0; i < chart->count; i++)
        if (chart->points[i].pareto)
            label_placer_put(&placer, log_axis_pixel(&chart->x, chart->points[i].error),
                             log_axis_pixel(&chart->y, chart->points[i].time_ms),
                             json_text_at(chart->points[i].json, "label"), overlay);
    for (int pareto = 0; pareto < 2; pareto++)
        for (size_t i = 0; i < chart->count; i++)
            if (chart->points[i].pareto == pareto)
                write_hover(chart, &chart->points[i], overlay);
}

enum status chart_speed(const json_t *scene, const struct chart_frame *frame, const char *row_prefix,
                        FILE *out)
{
    const json_t *points = json_object_get(scene, "points");
    struct speed_chart chart = {
        .frame = frame,
        .row_prefix = row_prefix,
        .points = calloc(json_array_size(points) + 1, sizeof(struct speed_point)),
        .x = {.name = 'x', .ticks = TICKS_POWERS_OF_TEN},
        .y = {.name = 'y', .ticks = TICKS_PLAIN},
    };
    struct box *taken = calloc(2 * json_array_size(points) + 1, sizeof(struct box));
    struct chart_drawing drawing;
    enum status status = STATUS_UNABLE;
    if (!chart.points || !taken) {
        log_error("no memory for a chart");
    } else if (chart_drawing_begin(&drawing) == STATUS_DONE) {
        chart_frame_span(frame, &chart.x);
        chart_frame_span(frame, &chart.y);
        read_points(points, &chart);
        write_script(&chart, drawing.script);
        if (frame->alone)
            write_title(frame, scene, drawing.overlay);
        write_overlay(&chart, taken, drawing.overlay);
        status = chart_drawing_end(&drawing, frame, "Time against error, both logarithmic.", out);
    }
    free(taken);
    free(chart.points);
    return status;
}
