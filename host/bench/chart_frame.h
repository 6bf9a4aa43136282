#ifndef VKWHITTED_BENCH_CHART_FRAME_H
#define VKWHITTED_BENCH_CHART_FRAME_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"
#include "bench/log_axis.h"

/* What a chart is drawn on. Lengths are pixels at the size it was designed for; SVG scales it. */
struct chart_frame {
    double width, height, font;
    double left, right, bottom; /* around the field that the axes span */
    double top;                 /* likewise; chart_frame_arrange() sets it */
    bool narrow;                /* for a phone */
    bool alone;                 /* a file of its own: white ground, no links to a table */
    const char *id;             /* before the ids of its elements */
};

/* Times the font's size it is the size of a mark in gnuplot's units. */
#define CHART_MARK_SIZE 0.055

/* What the marks and lines of a chart mean; listed above its field. */
struct chart_legend {
    struct {
        const char *title, *color; /* plain ASCII: gnuplot reads them */
        int shape;                 /* gnuplot's number of the mark, CHART_LINE or CHART_DASHES */
    } entries[12];
    size_t count;
};
enum { CHART_LINE = -1, CHART_DASHES = -2 };

void chart_legend_add(struct chart_legend *legend, const char *title, const char *color, int shape);

/* Sets the frame's top to leave room for the legend, and where the axes run. */
void chart_frame_arrange(struct chart_frame *frame, const struct chart_legend *legend, struct log_axis *x,
                         struct log_axis *y);

/* Writes the commands for gnuplot that are the same in all charts: terminal, margins, lines, legend, axes. */
void chart_frame_write(const struct chart_frame *frame, const struct chart_legend *legend,
                       const struct log_axis *x, const struct log_axis *y, FILE *script);

/* A drawing in the making: what gnuplot shall do, and the SVG elements that go over it. */
struct chart_drawing {
    FILE *script, *overlay;
    char *script_text, *overlay_text;
    size_t script_size, overlay_size;
};

/* Opens both streams. On STATUS_UNABLE (reported) nothing is left to clean up. */
enum status chart_drawing_begin(struct chart_drawing *drawing);

/* Closes both, and writes one <svg> element to out. description is for those who cannot see it. STATUS_UNABLE
 * has been reported. */
enum status chart_drawing_end(struct chart_drawing *drawing, const struct chart_frame *frame,
                              const char *description, FILE *out);

#endif
