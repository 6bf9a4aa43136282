#ifndef VKWHITTED_PIXEL_PRINT_PRIVATE_H
#define VKWHITTED_PIXEL_PRINT_PRIVATE_H

/* Shared by pixel_print.c, which walks through the ray tree, and pixel_line.c, which prints its quantities;
 * for no other file. */

#include "pixel/report.h"

/* A walk through the device's events. */
struct walk {
    const struct pixel_report *report;
    bool all_light_samples;
    struct step_finder reference, exact;
    int indent;
    int parted_at; /* the exact ray of so many bounces met another object than this one; INT_MAX: none did */
    bool marked;   /* the first difference has been shown */
};

/* One step, on all sides; the other two may be NULL. */
struct step {
    size_t i;
    const struct reference_event *device, *reference, *exact;
};

bool values_agree(const struct event_field *field, const struct reference_event *a,
                  const struct reference_event *b);

/* A line with one quantity; those of the reference only where they differ. */
void print_field(struct walk *walk, const struct step *step, const struct event_field *field);

/* A line with the margin of the decisions made in the step, if there is an analysis. */
void print_margin(const struct walk *walk, const struct step *step);

/* The mark at the first difference, which is in a quantity. */
void print_first_difference(struct walk *walk);

#endif
