#ifndef VKWHITTED_BENCH_CHART_LABELS_H
#define VKWHITTED_BENCH_CHART_LABELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct box {
    double left, top, right, bottom;
};

/* Finds room for labels beside their points. */
struct label_placer {
    struct box field; /* labels stay in here */
    double font;      /* pixels */
    struct box *taken;
    size_t taken_count; /* the caller provides room in taken for one more a label */
};

/* Takes the room of a point's marker. */
void label_placer_avoid(struct label_placer *placer, double x, double y);

/* Writes the label as an SVG <text> beside the point (x, y), if there is a side with room for it. */
bool label_placer_put(struct label_placer *placer, double x, double y, const char *label, FILE *overlay);

#endif
