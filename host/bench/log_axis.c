#include "bench/log_axis.h"

#include <math.h>

void log_axis_include(struct log_axis *axis, double value)
{
    if (value <= 0.0) {
        axis->has_zero = true;
    } else if (!isfinite(value)) {
        axis->has_infinity = true;
    } else {
        axis->low = axis->low > 0.0 ? fmin(axis->low, value) : value;
        axis->high = fmax(axis->high, value);
    }
}

void log_axis_finish(struct log_axis *axis)
{
    if (axis->low <= 0.0)
        axis->low = axis->high = 1.0;
    double low = log10(axis->low), high = log10(axis->high);
    double missing = 1.0 - (high - low); /* to one decade at least */
    double margin = fmax(0.04 * (high - low), 0.06) + (missing > 0.0 ? 0.5 * missing : 0.0);
    low -= margin;
    high += margin;
    double gutter = 0.07 * (high - low);
    axis->low = pow(10.0, low);
    axis->high = pow(10.0, high);
    axis->zero_at = pow(10.0, low - gutter);
    axis->infinity_at = pow(10.0, high + gutter);
    axis->from = axis->has_zero ? pow(10.0, low - 1.7 * gutter) : axis->low;
    axis->to = axis->has_infinity ? pow(10.0, high + 1.7 * gutter) : axis->high;
}

double log_axis_place(const struct log_axis *axis, double value)
{
    return value <= 0.0 ? axis->zero_at : isfinite(value) ? value : axis->infinity_at;
}

double log_axis_pixel(const struct log_axis *axis, double value)
{
    double fraction = log(log_axis_place(axis, value) / axis->from) / log(axis->to / axis->from);
    return axis->start + fraction * (axis->end - axis->start);
}

static void write_tick(const struct log_axis *axis, double mantissa, int power, bool labelled, FILE *script)
{
    double value = mantissa * pow(axis->ticks == TICKS_POWERS_OF_FOUR ? 4.0 : 10.0, power);
    if (value < axis->low || value > axis->high)
        return;
    if (!labelled)
        fprintf(script, ", \"\" %.9g 1", value);
    else if (axis->ticks != TICKS_POWERS_OF_TEN && value > 0.9e-3 && value < 1.1e5)
        fprintf(script, ", \"%.9g\" %.9g", value, value);
    else if (mantissa == 1.0)
        fprintf(script, ", \"10^{%d}\" %.9g", power, value);
    else
        fprintf(script, ", \"%g·10^{%d}\" %.9g", mantissa, power, value);
}

void log_axis_write(const struct log_axis *axis, FILE *script)
{
    const char name = axis->name;
    double base = axis->ticks == TICKS_POWERS_OF_FOUR ? 4.0 : 10.0;
    double first = log(axis->low) / log(base), last = log(axis->high) / log(base);
    double pixels = fabs(log_axis_pixel(axis, axis->high) - log_axis_pixel(axis, axis->low)) / (last - first);
    int stride = (int)fmax(1.0, ceil(axis->label_pixels / pixels));
    bool label_within = axis->ticks != TICKS_POWERS_OF_FOUR && pixels > 5.5 * axis->label_pixels;
    fprintf(script, "set logscale %c\nset %crange [%.9g:%.9g]\nset %ctics (\"0\" %.9g, \"∞\" %.9g", name,
            name, axis->from, axis->to, name, axis->zero_at, axis->infinity_at);
    for (int power = (int)floor(first); power <= (int)ceil(last); power++) {
        write_tick(axis, 1.0, power, power % stride == 0, script);
        for (int mantissa = 2; mantissa < 10 && axis->ticks != TICKS_POWERS_OF_FOUR && stride == 1;
             mantissa++)
            write_tick(axis, mantissa, power, label_within && (mantissa == 2 || mantissa == 5), script);
    }
    fputs(")\n", script);
    const double edges[] = {axis->low, axis->high};
    for (int side = 0; side < 2; side++)
        if (side == 0 ? axis->has_zero : axis->has_infinity)
            fprintf(script,
                    name == 'x' ? "set arrow from %.9g,graph 0 to %.9g,graph 1 %s\n"
                                : "set arrow from graph 0,%.9g to graph 1,%.9g %s\n",
                    edges[side], edges[side], "nohead back dt (2,3) lw 0.8 lc rgb \"#999999\"");
}
