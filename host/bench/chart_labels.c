#include "bench/chart_labels.h"

#include "bench/markup.h"

void label_placer_avoid(struct label_placer *placer, double x, double y)
{
    double half = 0.4 * placer->font;
    placer->taken[placer->taken_count++] = (struct box){x - half, y - half, x + half, y + half};
}

/* On the high side: no font is known, and most characters are narrower. */
static double text_width(const char *text, double font)
{
    double width = 0.0;
    for (; *text; text++)
        if ((*text & 0xC0) != 0x80) /* UTF-8: the first byte of a character */
            width += (unsigned char)*text < 0xE0 ? 0.56 * font : 1.05 * font;
    return width;
}

static bool has_room(const struct label_placer *placer, struct box box)
{
    const struct box *field = &placer->field;
    if (box.left < field->left || box.right > field->right || box.top < field->top ||
        box.bottom > field->bottom)
        return false;
    for (size_t i = 0; i < placer->taken_count; i++) {
        const struct box *taken = &placer->taken[i];
        if (box.left < taken->right && taken->left < box.right && box.top < taken->bottom &&
            taken->top < box.bottom)
            return false;
    }
    return true;
}

bool label_placer_put(struct label_placer *placer, double x, double y, const char *label, FILE *overlay)
{
    /* In units of the font; an anchor of 0 starts the text there, of 1 ends it. Not straight to the right:
     * there runs the front. */
    static const struct {
        double x, y, anchor;
    } places[] = {{0.4, -0.9, 0.0}, {-0.4, 0.9, 1.0}, {-0.7, 0.0, 1.0}, {0.4, 0.9, 0.0}, {-0.4, -0.9, 1.0}};
    const double font = placer->font, width = text_width(label, font);
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        double left = x + places[i].x * font - places[i].anchor * width, middle = y + places[i].y * font;
        struct box box = {left, middle - 0.55 * font, left + width, middle + 0.55 * font};
        if (!has_room(placer, box))
            continue;
        placer->taken[placer->taken_count++] = box;
        fprintf(overlay,
                "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"%s\" font-family=\"sans-serif\" font-size=\"%g\" "
                "fill=\"#222222\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" "
                "paint-order=\"stroke\">",
                x + places[i].x * font, middle + 0.35 * font, places[i].anchor > 0.0 ? "end" : "start", font);
        markup_text(overlay, label);
        fputs("</text>\n", overlay);
        return true;
    }
    return false;
}
