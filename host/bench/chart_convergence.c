#include "bench/chart_convergence.h"

#include <math.h>

#include "bench/json_value.h"
#include "bench/markup.h"

struct convergence_chart {
    struct chart_frame frame;
    struct chart_legend legend;
    const json_t *values, *rmse;
    size_t count;
    double slope, slope_from, slope_to;
    struct log_axis x, y;
};

static double number_in(const json_t *array, size_t index)
{
    const json_t *value = json_array_get(array, index);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

/* The logarithm of the fitted line's error at N = 1: it goes through the middle of the points it was fitted
 * to. */
static double fitted_height(const struct convergence_chart *chart)
{
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < chart->count; i++) {
        double n = number_in(chart->values, i), error = number_in(chart->rmse, i);
        if (n >= chart->slope_from && n <= chart->slope_to && error > 0.0) {
            sum += log(error) - chart->slope * log(n);
            count += 1.0;
        }
    }
    return sum / count;
}

static void write_script(struct convergence_chart *chart, FILE *script)
{
    char fitted[32];
    double height = fitted_height(chart);
    bool has_fit = isfinite(chart->slope) && isfinite(height);
    chart_legend_add(&chart->legend, "measured", "#222222", 7);
    if (has_fit) {
        snprintf(fitted, sizeof fitted, "fitted, N^{%.2f}", chart->slope);
        chart_legend_add(&chart->legend, fitted, "#0072b2", CHART_LINE);
        chart_legend_add(&chart->legend, "random, N^{-1/2}", "#777777", CHART_DASHES);
    }
    chart_frame_arrange(&chart->frame, &chart->legend, &chart->x, &chart->y);
    chart_frame_write(&chart->frame, &chart->legend, &chart->x, &chart->y, script);
    fputs("$points << END\n", script);
    for (size_t i = 0; i < chart->count; i++)
        fprintf(script, "%.9g %.9g\n", number_in(chart->values, i),
                log_axis_place(&chart->y, number_in(chart->rmse, i)));
    fputs("END\nplot NaN", script); /* a range after plot itself would be the axis' */
    if (has_fit) {
        double from = chart->slope_from, to = chart->slope_to, start = height + chart->slope * log(from);
        fprintf(script, ", [%.9g:%.9g] exp(%.9g - 0.5 * log(x / %.9g)) dt (6,4) lc rgb \"#777777\"", from, to,
                start, from);
        fprintf(script, ", [%.9g:%.9g] exp(%.9g + %.9g * log(x)) dt 1 lw 1.5 lc rgb \"#0072b2\"", from, to,
                height, chart->slope);
    }
    fprintf(script, ", $points with points pt 7 ps %g lc rgb \"#222222\"\n",
            CHART_MARK_SIZE * chart->frame.font);
}

static void write_overlay(const struct convergence_chart *chart, FILE *overlay)
{
    char number[MARKUP_NUMBER_SIZE];
    for (size_t i = 0; i < chart->count; i++) {
        double n = number_in(chart->values, i), error = number_in(chart->rmse, i);
        fprintf(overlay,
                "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" fill=\"none\" pointer-events=\"all\">"
                "<title>N = %.0f: RMSE %s</title></circle>\n",
                log_axis_pixel(&chart->x, n), log_axis_pixel(&chart->y, error), 0.6 * chart->frame.font, n,
                markup_error(error, number));
    }
}

enum status chart_convergence(const json_t *convergence, const struct chart_frame *frame, FILE *out)
{
    struct convergence_chart chart = {
        .frame = *frame,
        .values = json_object_get(convergence, "values"),
        .rmse = json_object_get(convergence, "rmse"),
        .slope = json_number_at(convergence, "slope"),
        .slope_from = json_number_at(convergence, "slope_from"),
        .slope_to = json_number_at(convergence, "slope_to"),
        .x = {.name = 'x', .title = "samples N", .ticks = TICKS_POWERS_OF_FOUR},
        .y = {.name = 'y', .title = "error (RMSE)", .ticks = TICKS_POWERS_OF_TEN},
    };
    chart.count = json_array_size(chart.values);
    for (size_t i = 0; i < chart.count; i++) {
        log_axis_include(&chart.x, number_in(chart.values, i));
        log_axis_include(&chart.y, number_in(chart.rmse, i));
    }
    log_axis_finish(&chart.x);
    log_axis_finish(&chart.y);

    struct chart_drawing drawing;
    if (chart_drawing_begin(&drawing) != STATUS_DONE)
        return STATUS_UNABLE;
    write_script(&chart, drawing.script);
    write_overlay(&chart, drawing.overlay);
    return chart_drawing_end(&drawing, &chart.frame, "Error against the number of samples, both logarithmic.",
                             out);
}
