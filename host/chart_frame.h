#ifndef VKWHITTED_CHART_FRAME_H
#define VKWHITTED_CHART_FRAME_H

#include <stdbool.h>
#include <stdio.h>

#include "log_axis.h"
#include "status.h"

/* What a chart is drawn on. Lengths are pixels at the size it was designed for; SVG scales it. */
struct chart_frame {
    double width, height, font;
    double left, right, top, bottom; /* around the field that the axes span */
    bool narrow;                     /* for a phone */
    bool alone;                      /* a file of its own: white ground, no links to a table */
    const char *id;                  /* before the ids of its elements */
};

/* Sets where the axis runs in the frame, by its name. */
void chart_frame_span(const struct chart_frame *frame, struct log_axis *axis);

/* Writes the commands for gnuplot that are the same in all charts: terminal, margins, lines, both axes. */
void chart_frame_write(const struct chart_frame *frame, const struct log_axis *x, const struct log_axis *y,
                       FILE *script);

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
