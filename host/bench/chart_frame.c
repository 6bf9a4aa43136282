#include "bench/chart_frame.h"

#include <math.h>
#include <stdlib.h>

#include "bench/gnuplot.h"
#include "bench/markup.h"

enum { TITLE_HEIGHT = 36, LEGEND_X = 16 };

void chart_legend_add(struct chart_legend *legend, const char *title, const char *color, int shape)
{
    size_t room = sizeof legend->entries / sizeof legend->entries[0];
    if (legend->count == room)
        return;
    legend->entries[legend->count].title = title;
    legend->entries[legend->count].color = color;
    legend->entries[legend->count++].shape = shape;
}

static size_t legend_columns(const struct chart_frame *frame)
{
    return (size_t)fmax(1.0, floor((frame->width - LEGEND_X) / (12.5 * frame->font)));
}

static void write_legend(const struct chart_frame *frame, const struct chart_legend *legend, FILE *script)
{
    size_t columns = legend_columns(frame), rows = (legend->count + columns - 1) / columns;
    for (size_t i = 0; i < legend->count; i++) {
        double left = LEGEND_X + (double)(i / rows) * 12.5 * frame->font;
        double middle = (frame->alone ? TITLE_HEIGHT : 0) + (0.9 + 1.5 * (double)(i % rows)) * frame->font;
        double x = left / frame->width, y = 1.0 - middle / frame->height;
        int shape = legend->entries[i].shape;
        const char *color = legend->entries[i].color;
        fprintf(script, "set label \"%s\" at screen %.9g,%.9g left\n", legend->entries[i].title,
                x + 1.1 * frame->font / frame->width, y);
        if (shape < 0)
            fprintf(script,
                    "set arrow from screen %.9g,%.9g rto screen %.9g,0 nohead lw 1.5 %s lc rgb \"%s\"\n",
                    x - 0.7 * frame->font / frame->width, y, 1.4 * frame->font / frame->width,
                    shape == CHART_DASHES ? "dt (4,3)" : "dt 1", color);
        else
            fprintf(script, "set label \"\" at screen %.9g,%.9g point pt %d ps %g lc rgb \"%s\"\n", x, y,
                    shape, CHART_MARK_SIZE * frame->font, color);
    }
}

static void span(const struct chart_frame *frame, struct log_axis *axis)
{
    axis->start = axis->name == 'x' ? frame->left : frame->height - frame->bottom;
    axis->end = axis->name == 'x' ? frame->width - frame->right : frame->top;
    axis->label_pixels = axis->name == 'x' ? 3.2 * frame->font : 1.6 * frame->font;
}

void chart_frame_arrange(struct chart_frame *frame, const struct chart_legend *legend, struct log_axis *x,
                         struct log_axis *y)
{
    size_t columns = legend_columns(frame), rows = (legend->count + columns - 1) / columns;
    frame->top = (frame->alone ? TITLE_HEIGHT : 0) + (1.5 * (double)rows + 2.6) * frame->font;
    span(frame, x);
    span(frame, y);
}

void chart_frame_write(const struct chart_frame *frame, const struct chart_legend *legend,
                       const struct log_axis *x, const struct log_axis *y, FILE *script)
{
    fprintf(script, "set terminal svg size %g,%g dynamic enhanced font \"sans-serif,%g\"\n", frame->width,
            frame->height, frame->font);
    fprintf(script, "set encoding utf8\nset lmargin at screen %.9g\nset rmargin at screen %.9g\n",
            frame->left / frame->width, 1.0 - frame->right / frame->width);
    fprintf(script, "set tmargin at screen %.9g\nset bmargin at screen %.9g\n",
            1.0 - frame->top / frame->height, frame->bottom / frame->height);
    fputs(
        "set border 3 lc rgb \"#666666\" lw 0.8\nset tics nomirror scale 0.6,0.3 textcolor rgb \"#333333\"\n"
        "set grid xtics ytics lt 1 lc rgb \"#d8d8d8\" lw 0.6\nset errorbars small\nunset key\n",
        script);
    fprintf(script, "set label \"%s\" at screen %.9g,%.9g right textcolor rgb \"#333333\"\n", x->title,
            1.0 - frame->right / frame->width, 0.7 * frame->font / frame->height);
    fprintf(script, "set label \"%s\" at screen %.9g,%.9g left textcolor rgb \"#333333\"\n", y->title,
            8.0 / frame->width, 1.0 - (frame->top - 1.1 * frame->font) / frame->height);
    write_legend(frame, legend, script);
    log_axis_write(x, script);
    log_axis_write(y, script);
}

enum status chart_drawing_begin(struct chart_drawing *drawing)
{
    *drawing = (struct chart_drawing){0};
    drawing->script = open_memstream(&drawing->script_text, &drawing->script_size);
    drawing->overlay = open_memstream(&drawing->overlay_text, &drawing->overlay_size);
    if (drawing->script && drawing->overlay)
        return STATUS_DONE;
    if (drawing->script)
        fclose(drawing->script);
    if (drawing->overlay)
        fclose(drawing->overlay);
    free(drawing->script_text);
    free(drawing->overlay_text);
    log_error("no memory for a chart");
    return STATUS_UNABLE;
}

static enum status draw(const struct chart_drawing *drawing, const struct chart_frame *frame,
                        const char *description, FILE *out)
{
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
            "viewBox=\"0 0 %g %g\" role=\"img\"",
            frame->width, frame->height);
    if (frame->alone)
        fprintf(out, " width=\"%g\" height=\"%g\"", frame->width, frame->height);
    else
        fprintf(out, " class=\"%s\"", frame->narrow ? "narrow" : "wide");
    fputs(" aria-label=\"", out);
    markup_text(out, description);
    fputs("\">\n", out);
    if (frame->alone)
        fprintf(out, "<rect width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n", frame->width, frame->height);
    enum status status = gnuplot_draw(drawing->script_text, frame->id, out);
    fputs(drawing->overlay_text, out);
    fputs("</svg>\n", out);
    return status;
}

enum status chart_drawing_end(struct chart_drawing *drawing, const struct chart_frame *frame,
                              const char *description, FILE *out)
{
    enum status status = STATUS_UNABLE;
    bool script_complete = fclose(drawing->script) == 0, overlay_complete = fclose(drawing->overlay) == 0;
    if (script_complete && overlay_complete)
        status = draw(drawing, frame, description, out);
    else
        log_error("no memory for a chart");
    free(drawing->script_text);
    free(drawing->overlay_text);
    return status;
}
