#ifndef VKWHITTED_PIXEL_REPORT_H
#define VKWHITTED_PIXEL_REPORT_H

#include "base/json.h"
#include "pixel/fields.h"
#include "scene/pack.h"

/* All that is known of a pixel. */
struct pixel_report {
    const char *scene_path, *device, *driver;
    const struct scene *scene;
    const struct packed_scene *packed;
    double scale;                                    /* scene units in a metre */
    unsigned x, y;                                   /* pixels from the top left */
    enum precision precision, against;               /* against: PRECISION_FLOAT where there is no analysis */
    struct pixel_events on_device, reference, exact; /* exact: the analysis */
    double picture[3], reference_picture[3];         /* the pixel as rendered without recording */
    struct event_difference difference;
};

/* Finds the steps of one side that are the same as those of another: of the same ray, and on it the same. */
struct step_finder {
    const struct pixel_events *events;
    const struct reference_event **sorted;
    size_t next;
};

/* The caller frees finder->sorted. */
enum status step_finder_create(const struct pixel_events *events, struct step_finder *finder);

/* NULL if there is none. Steps that are asked for in their order are found at once. */
const struct reference_event *find_step(struct step_finder *finder, const struct reference_event *event);

/* Whether the picture's pixels and those that were recorded are the same. */
bool pixel_is_the_pictures(const struct pixel_report *report);

/* The name of an object by the number of its surface; "nothing" below 0. */
const char *surface_name(const struct pixel_report *report, double surface);

/* Whether the analysis computes this quantity. */
bool exact_knows(const struct event_field *field);

/* Float's unit in the last place of a component of the field's exact value; of its largest, if that is 0. */
double unit_in_last_place(const struct reference_event *exact, const struct event_field *field,
                          int component);

enum { BITS_TEXT = 20 };

/* The bits of a number in the report's precision, in hexadecimal. */
void print_bits(const struct pixel_report *report, double value, char text[static BITS_TEXT]);

/* Prints the ray tree. all_light_samples: otherwise those of a light are summed up. */
enum status pixel_print(const struct pixel_report *report, bool all_light_samples);

/* Prints in a line whether device and reference agree. */
void pixel_print_verdict(const struct pixel_report *report);

/* As a JSON object; NULL without memory. */
json_t *pixel_json(const struct pixel_report *report);

#endif
