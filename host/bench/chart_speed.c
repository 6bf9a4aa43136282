#include "bench/chart_speed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/chart_labels.h"
#include "bench/json_value.h"
#include "bench/markup.h"

/* What the bench varies, and how it looks. The colours are Okabe and Ito's, which the colour-blind tell
 * apart; the shapes, in gnuplot's numbers, do without colour, the open one is for fast mode. The last takes
 * what has another name. */
static const struct {
    const char *family, *title, *color;
    int shape, open_shape;
} families[] = {
    {"mode", "modes", "#222222", 7, 6},
    {"max-error", "max error", "#0072b2", 5, 4},
    {"bounces", "bounces", "#d55e00", 9, 8},
    {"light-samples", "light samples", "#009e73", 11, 10},
    {"samples", "samples a pixel", "#b4508c", 13, 12},
    {"cpu", "CPU", "#777777", 2, 2},
    {"", "others", "#777777", 1, 1},
};
enum { FAMILY_COUNT = sizeof families / sizeof families[0] };

/* Of the settings that share a truth, and of those with one of their own. */
static const struct {
    const char *title, *color;
    int shape;
} fronts[] = {
    {"Pareto front", "#808080", CHART_LINE},
    {"front, samples", "#b4508c", CHART_DASHES},
};

struct speed_point {
    const json_t *json;
    size_t row; /* in the scene's points */
    size_t family;
    double error, time_ms;
    bool fast, pareto;
};

struct speed_chart {
    struct chart_frame frame;
    struct chart_legend legend;
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

static double quartile(const struct speed_point *point, size_t index)
{
    const json_t *value = json_array_get(json_object_get(point->json, "time_quartiles_ms"), index);
    double time_ms = json_number_value(value);
    return time_ms > 0.0 ? time_ms : point->time_ms;
}

static void read_points(const json_t *points, struct speed_chart *chart)
{
    for (size_t i = 0; i < json_array_size(points); i++) {
        const json_t *json = json_array_get(points, i);
        struct speed_point point = {
            .json = json,
            .row = i,
            .error = json_number_at(json_object_get(json, "error"), "absolute_999"),
            .time_ms = json_number_at(json, "time_ms"),
            .fast = strcmp(json_text_at(json, "mode"), "fast") == 0,
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
        log_axis_include(&chart->y, quartile(&point, 0));
        log_axis_include(&chart->y, point.time_ms);
        log_axis_include(&chart->y, quartile(&point, 1));
        chart->points[chart->count++] = point;
    }
    qsort(chart->points, chart->count, sizeof chart->points[0], compare_points);
    log_axis_finish(&chart->x);
    log_axis_finish(&chart->y);
}

static bool is_on_front(const struct speed_point *point, bool own_truth)
{
    return point->pareto && has_own_truth(point) == own_truth;
}

static bool has_front(const struct speed_chart *chart, bool own_truth)
{
    for (size_t i = 0; i < chart->count; i++)
        if (is_on_front(&chart->points[i], own_truth))
            return true;
    return false;
}

static bool has_family(const struct speed_chart *chart, size_t family, bool fast)
{
    for (size_t i = 0; i < chart->count; i++)
        if (chart->points[i].family == family && chart->points[i].fast == fast)
            return true;
    return false;
}

static void make_legend(struct speed_chart *chart)
{
    bool fast = false;
    for (size_t family = 0; family < FAMILY_COUNT; family++) {
        fast = fast || has_family(chart, family, true);
        if (has_family(chart, family, false) || has_family(chart, family, true))
            chart_legend_add(&chart->legend, families[family].title, families[family].color,
                             families[family].shape);
    }
    if (fast)
        chart_legend_add(&chart->legend, "open: fast", families[0].color, families[0].open_shape);
    for (int own_truth = 0; own_truth < 2; own_truth++)
        if (has_front(chart, own_truth))
            chart_legend_add(&chart->legend, fronts[own_truth].title, fronts[own_truth].color,
                             fronts[own_truth].shape);
}

/* The data of a curve of steps: at an error one can have the time of the last point before it. */
static void write_front(const struct speed_chart *chart, bool own_truth, FILE *script)
{
    double time_ms = 0.0;
    fprintf(script, "$front%d << END\n", own_truth);
    for (size_t i = 0; i < chart->count; i++) {
        const struct speed_point *point = &chart->points[i];
        if (!is_on_front(point, own_truth))
            continue;
        time_ms = point->time_ms;
        fprintf(script, "%.9g %.9g\n", log_axis_place(&chart->x, point->error), time_ms);
    }
    fprintf(script, "%.9g %.9g\nEND\n", chart->x.to, time_ms);
}

static void write_family(const struct speed_chart *chart, size_t family, bool fast, FILE *script)
{
    fprintf(script, "$family%zu_%d << END\n", family, fast);
    for (size_t i = 0; i < chart->count; i++) {
        const struct speed_point *point = &chart->points[i];
        if (point->family == family && point->fast == fast)
            fprintf(script, "%.9g %.9g %.9g %.9g\n", log_axis_place(&chart->x, point->error), point->time_ms,
                    quartile(point, 0), quartile(point, 1));
    }
    fputs("END\n", script);
}

static void write_script(const struct speed_chart *chart, FILE *script)
{
    chart_frame_write(&chart->frame, &chart->legend, &chart->x, &chart->y, script);
    for (int own_truth = 0; own_truth < 2; own_truth++)
        write_front(chart, own_truth, script);
    for (size_t family = 0; family < FAMILY_COUNT; family++)
        for (int fast = 0; fast < 2; fast++)
            write_family(chart, family, fast, script);

    fputs("plot NaN", script); /* what follows begins with a comma */
    for (int own_truth = 0; own_truth < 2; own_truth++)
        if (has_front(chart, own_truth))
            fprintf(script, ", $front%d with steps lw 1.5 dt %s lc rgb \"%s\"", own_truth,
                    fronts[own_truth].shape == CHART_DASHES ? "(6,4)" : "1", fronts[own_truth].color);
    for (size_t family = 0; family < FAMILY_COUNT; family++)
        for (int fast = 0; fast < 2; fast++)
            if (has_family(chart, family, fast))
                fprintf(script, ", $family%zu_%d with yerrorbars pt %d ps %g dt 1 lc rgb \"%s\"", family,
                        fast, fast ? families[family].open_shape : families[family].shape,
                        CHART_MARK_SIZE * chart->frame.font, families[family].color);
    fputc('\n', script);
}

static void write_hover(const struct speed_chart *chart, const struct speed_point *point, FILE *overlay)
{
    char number[MARKUP_NUMBER_SIZE];
    const json_t *error = json_object_get(point->json, "error");
    if (!chart->frame.alone)
        fprintf(overlay, "<a href=\"#%s%zu\">", chart->row_prefix, point->row);
    fprintf(overlay, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" fill=\"none\" pointer-events=\"all\"><title>",
            log_axis_pixel(&chart->x, point->error), log_axis_pixel(&chart->y, point->time_ms),
            0.6 * chart->frame.font);
    markup_text(overlay, json_text_at(point->json, "label"));
    fprintf(overlay, "\n%s ms", markup_number(point->time_ms, number));
    fprintf(overlay, " (quartiles %s", markup_number(quartile(point, 0), number));
    fprintf(overlay, " to %s)\n99.9 %% of the pixels within ", markup_number(quartile(point, 1), number));
    fprintf(overlay, "%s, RMSE ", markup_error(point->error, number));
    fprintf(overlay, "%s, max error ", markup_error(json_number_at(error, "rmse"), number));
    fputs(markup_error(json_number_at(error, "max"), number), overlay);
    fputs(point->pareto ? "\non the Pareto front</title></circle>" : "</title></circle>", overlay);
    fputs(chart->frame.alone ? "\n" : "</a>\n", overlay);
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
    const struct chart_frame *frame = &chart->frame;
    struct label_placer placer = {
        .field = {frame->left, frame->top - 0.6 * frame->font, frame->width - 4.0,
                  frame->height - frame->bottom},
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
        .frame = *frame,
        .row_prefix = row_prefix,
        .points = calloc(json_array_size(points) + 1, sizeof(struct speed_point)),
        .x = {.name = 'x',
              .title = "error of 99.9 % of the pixels (linear radiance)",
              .ticks = TICKS_POWERS_OF_TEN},
        .y = {.name = 'y', .title = "time, ms", .ticks = TICKS_PLAIN},
    };
    struct box *taken = calloc(2 * json_array_size(points) + 1, sizeof(struct box));
    struct chart_drawing drawing;
    enum status status = STATUS_UNABLE;
    if (!chart.points || !taken) {
        log_error("no memory for a chart");
    } else if (chart_drawing_begin(&drawing) == STATUS_DONE) {
        read_points(points, &chart);
        make_legend(&chart);
        chart_frame_arrange(&chart.frame, &chart.legend, &chart.x, &chart.y);
        write_script(&chart, drawing.script);
        if (frame->alone)
            write_title(frame, scene, drawing.overlay);
        write_overlay(&chart, taken, drawing.overlay);
        status = chart_drawing_end(&drawing, &chart.frame, "Time against error, both logarithmic.", out);
    }
    free(taken);
    free(chart.points);
    return status;
}
