#include "chart_convergence.h"

#include <math.h>

#include "json_value.h"
#include "markup.h"

struct convergence_chart {
    const struct chart_frame *frame;
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

static void write_script(const struct convergence_chart *chart, FILE *script)
{
    const struct chart_frame *frame = chart->frame;
    chart_frame_write(frame, &chart->x, &chart->y, script);
    fprintf(script, "set key at screen %.9g,%.9g left top horizontal Left reverse samplen 1.5 width 1\n",
            8.0 / frame->width, 1.0 - 4.0 / frame->height);
    fputs("set xlabel \"samples N\" textcolor rgb \"#333333\"\n", script);
    fprintf(script, "set label \"error (RMSE)\" at screen %.9g,%.9g left textcolor rgb \"#333333\"\n",
            8.0 / frame->width, 1.0 - (frame->top - 1.1 * frame->font) / frame->height);
    fputs("$points << END\n", script);
    for (size_t i = 0; i < chart->count; i++)
        fprintf(script, "%.9g %.9g\n", number_in(chart->values, i),
                log_axis_place(&chart->y, number_in(chart->rmse, i)));
    fputs("END\nplot NaN notitle", script);
    double height = fitted_height(chart);
    if (isfinite(chart->slope) && isfinite(height)) {
        double from = chart->slope_from, to = chart->slope_to, start = height + chart->slope * log(from);
        fprintf(script,
                ", [%.9g:%.9g] exp(%.9g - 0.5 * log(x / %.9g)) lt 1 dt (6,4) lc rgb \"#777777\" title "
                "\"N^{-1/2}, random points\"",
                from, to, start, from);
        fprintf(script,
                ", [%.9g:%.9g] exp(%.9g + %.9g * log(x)) lt 1 lw 1.5 lc rgb \"#0072b2\" title "
                "\"fitted, N^{%.2f}\"",
                from, to, height, chart->slope, chart->slope);
    }
    fprintf(script, ", $points using 1:2 with points pt 7 ps %g lc rgb \"#222222\" title \"measured\"\n",
            0.05 * frame->font);
}

static void write_overlay(const struct convergence_chart *chart, FILE *overlay)
{
    char number[MARKUP_NUMBER_SIZE];
    for (size_t i = 0; i < chart->count; i++) {
        double n = number_in(chart->values, i), error = number_in(chart->rmse, i);
        fprintf(overlay,
                "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" fill=\"none\" pointer-events=\"all\">"
                "<title>N = %.0f: RMSE %s</title></circle>\n",
                log_axis_pixel(&chart->x, n), log_axis_pixel(&chart->y, error), 0.6 * chart->frame->font, n,
                markup_error(error, number));
    }
}

enum status chart_convergence(const json_t *convergence, const struct chart_frame *frame, FILE *out)
{
    struct convergence_chart chart = {
        .frame = frame,
        .values = json_object_get(convergence, "values"),
        .rmse = json_object_get(convergence, "rmse"),
        .slope = json_number_at(convergence, "slope"),
        .slope_from = json_number_at(convergence, "slope_from"),
        .slope_to = json_number_at(convergence, "slope_to"),
        .x = {.name = 'x', .ticks = TICKS_POWERS_OF_FOUR},
        .y = {.name = 'y', .ticks = TICKS_POWERS_OF_TEN},
    };
    chart.count = json_array_size(chart.values);
    for (size_t i = 0; i < chart.count; i++) {
        log_axis_include(&chart.x, number_in(chart.values, i));
        log_axis_include(&chart.y, number_in(chart.rmse, i));
    }
    chart_frame_span(frame, &chart.x);
    chart_frame_span(frame, &chart.y);
    log_axis_finish(&chart.x);
    log_axis_finish(&chart.y);

    struct chart_drawing drawing;
    if (chart_drawing_begin(&drawing) != STATUS_DONE)
        return STATUS_UNABLE;
    write_script(&chart, drawing.script);
    write_overlay(&chart, drawing.overlay);
    return chart_drawing_end(&drawing, frame, "Error against the number of samples, both logarithmic.", out);
}
