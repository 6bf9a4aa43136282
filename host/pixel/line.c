#include <math.h>
#include <stdio.h>

#include "base/number.h"
#include "pixel/print_private.h"

enum { NAME_WIDTH = 16 };

static void print_number(double value)
{
    char text[NUMBER_TEXT];
    format_number(value, text);
    fputs(text, stdout);
}

static void print_value(const struct pixel_report *report, const struct event_field *field, double value)
{
    static const char *const shines[] = {"too near to shine", "behind the surface", "shadow ray"};
    switch (field->type) {
    case FIELD_VALUE:
        print_number(value / pow(report->scale, field->metres));
        break;
    case FIELD_FLAG:
        fputs(value != 0 ? "yes" : "no", stdout);
        break;
    case FIELD_OBJECT:
        fputs(surface_name(report, value), stdout);
        break;
    case FIELD_NUMBER:
        fputs(value >= 0 && value < 3 ? shines[(int)value] : "?", stdout);
        break;
    }
}

static void print_values(const struct pixel_report *report, const struct event_field *field,
                         const struct reference_event *event)
{
    for (int c = 0; c < field->count; ++c) {
        if (c > 0)
            putchar(' ');
        print_value(report, field, event_value(event, field, c));
    }
}

/* Float's error and what it may be. */
static void print_error(const struct event_field *field, const struct step *step)
{
    fputs("  [", stdout);
    for (int c = 0; c < field->count; ++c) {
        double error = event_value(step->device, field, c) - event_value(step->exact, field, c);
        printf("%s%+.3g", c > 0 ? " " : "", error / unit_in_last_place(step->exact, field, c));
    }
    fputs(" ulp, bound", stdout);
    for (int c = 0; c < field->count; ++c)
        printf(" %.3g", step->exact->bounds[field->first + c] / unit_in_last_place(step->exact, field, c));
    putchar(']');
}

bool values_agree(const struct event_field *field, const struct reference_event *a,
                  const struct reference_event *b)
{
    bool agree = true;
    for (int c = 0; c < field->count; ++c)
        agree = agree && event_values_agree(event_value(a, field, c), event_value(b, field, c));
    return agree;
}

void print_first_difference(struct walk *walk)
{
    static const char *const components[] = {".x", ".y", ".z"};
    const struct pixel_report *report = walk->report;
    const struct event_difference *difference = &report->difference;
    const struct event_field *field = difference->field;
    printf("  <-- first difference: %s%s", field->name,
           field->count > 1 ? components[difference->component] : "");
    for (int side = 0; side < 2; ++side) {
        const struct pixel_events *events = side == 0 ? &report->on_device : &report->reference;
        double value = event_value(&events->events[difference->event], field, difference->component);
        char bits[BITS_TEXT];
        print_bits(report, value, bits);
        printf("%s%s%s", side == 0 ? ", device " : ", reference ", field->type == FIELD_VALUE ? bits : "",
               field->type == FIELD_VALUE ? " " : "");
        print_value(report, field, value);
    }
    walk->marked = true;
}

static void begin_line(const struct walk *walk, const char *name)
{
    printf("%*s%-*s ", walk->indent, "", NAME_WIDTH, name);
}

void print_field(struct walk *walk, const struct step *step, const struct event_field *field)
{
    begin_line(walk, field->name);
    print_values(walk->report, field, step->device);
    if (step->reference && !values_agree(field, step->device, step->reference)) {
        fputs("  reference ", stdout);
        print_values(walk->report, field, step->reference);
    }
    if (!step->exact || !exact_knows(field))
        ;
    else if (field->type == FIELD_VALUE)
        print_error(field, step);
    else if (!values_agree(field, step->device, step->exact)) {
        printf("  %s ", precision_name(walk->report->against));
        print_values(walk->report, field, step->exact);
    }
    const struct event_difference *difference = &walk->report->difference;
    if (difference->differs && difference->event == step->i && difference->field == field)
        print_first_difference(walk);
    putchar('\n');
}

void print_margin(const struct walk *walk, const struct step *step)
{
    if (!step->exact || !isfinite(step->exact->margin))
        return;
    begin_line(walk, "margin");
    printf("%.3g%s\n", step->exact->margin, step->exact->margin < 1 ? "  float may decide otherwise" : "");
}
