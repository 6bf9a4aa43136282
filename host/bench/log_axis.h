#ifndef VKWHITTED_BENCH_LOG_AXIS_H
#define VKWHITTED_BENCH_LOG_AXIS_H

#include <stdbool.h>
#include <stdio.h>

/* A logarithmic axis of a chart. Values that have no place on one, 0 and infinity, get a place of their own
 * outside the range of the others. */
struct log_axis {
    char name; /* 'x' or 'y' */
    const char *title;
    double start, end;   /* pixels, in SVG's coordinates */
    double label_pixels; /* room for one tick's label along the axis */
    enum { TICKS_POWERS_OF_TEN, TICKS_PLAIN, TICKS_POWERS_OF_FOUR } ticks;
    bool has_zero, has_infinity;
    double low, high;            /* of the finite values above 0 */
    double zero_at, infinity_at; /* where those two are put */
    double from, to;             /* all that is shown */
};

/* Widens the axis to hold a value; NAN counts as infinite, what is below 0 as 0. Before the first, low and
 * high are 0. */
void log_axis_include(struct log_axis *axis, double value);

/* After the last value: settles the range. */
void log_axis_finish(struct log_axis *axis);

/* The value that stands for this one in the chart. */
double log_axis_place(const struct log_axis *axis, double value);

/* Where that is, in pixels. */
double log_axis_pixel(const struct log_axis *axis, double value);

/* Writes gnuplot's commands for scale, range and ticks. */
void log_axis_write(const struct log_axis *axis, FILE *script);

#endif
