#include "chart_frame.h"

#include <stdlib.h>

#include "gnuplot.h"
#include "markup.h"

void chart_frame_span(const struct chart_frame *frame, struct log_axis *axis)
{
    axis->start = axis->name == 'x' ? frame->left : frame->height - frame->bottom;
    axis->end = axis->name == 'x' ? frame->width - frame->right : frame->top;
    axis->label_pixels = axis->name == 'x' ? 3.2 * frame->font : 1.6 * frame->font;
}

void chart_frame_write(const struct chart_frame *frame, const struct log_axis *x, const struct log_axis *y,
                       FILE *script)
{
    fprintf(script, "set terminal svg size %g,%g dynamic enhanced font \"sans-serif,%g\"\n", frame->width,
            frame->height, frame->font);
    fprintf(script, "set encoding utf8\nset lmargin at screen %.9g\nset rmargin at screen %.9g\n",
            frame->left / frame->width, 1.0 - frame->right / frame->width);
    fprintf(script, "set tmargin at screen %.9g\nset bmargin at screen %.9g\n",
            1.0 - frame->top / frame->height, frame->bottom / frame->height);
    fputs(
        "set border 3 lc rgb \"#666666\" lw 0.8\nset tics nomirror scale 0.6,0.3 textcolor rgb \"#333333\"\n"
        "set grid xtics ytics lt 1 lc rgb \"#e2e2e2\" lw 0.6\nset errorbars small\n",
        script);
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
    if (!frame->alone)
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
