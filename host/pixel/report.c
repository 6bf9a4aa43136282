#include "pixel/report.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int compare_ints(const int *a, const int *b, int count)
{
    for (int i = 0; i < count; ++i)
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare_steps(const struct reference_event *a, const struct reference_event *b)
{
    const layout_ivec4 p = a->head.place, q = b->head.place;
    bool named = p.x == EVENT_LIGHT || p.x == EVENT_UNTRACED; /* which of several, by its facts */
    const int one[] = {p.y, p.z, p.w, p.x, a->head.facts.x, a->head.facts.y};
    const int other[] = {q.y, q.z, q.w, q.x, b->head.facts.x, b->head.facts.y};
    return compare_ints(one, other, named ? 6 : 4);
}

static int compare_pointers(const void *a, const void *b)
{
    const struct reference_event *const *p = a, *const *q = b;
    return compare_steps(*p, *q);
}

enum status step_finder_create(const struct pixel_events *events, struct step_finder *finder)
{
    *finder = (struct step_finder){events, calloc(events->count + 1, sizeof *finder->sorted), 0};
    if (!finder->sorted) {
        log_error("no memory for %zu events", events->count);
        return STATUS_UNABLE;
    }
    for (size_t i = 0; i < events->count; ++i)
        finder->sorted[i] = &events->events[i];
    qsort(finder->sorted, events->count, sizeof *finder->sorted, compare_pointers);
    return STATUS_DONE;
}

const struct reference_event *find_step(struct step_finder *finder, const struct reference_event *event)
{
    const struct pixel_events *events = finder->events;
    if (finder->next < events->count && compare_steps(event, &events->events[finder->next]) == 0)
        return &events->events[finder->next++];
    const struct reference_event *const *found =
        bsearch(&event, finder->sorted, events->count, sizeof *finder->sorted, compare_pointers);
    if (!found)
        return NULL;
    finder->next = (size_t)(*found - events->events) + 1;
    return *found;
}

static bool agrees(const double picture[3], const struct pixel_events *events)
{
    if (events->count == 0 || events->events[events->count - 1].head.place.x != EVENT_PIXEL)
        return events->beyond > 0; /* not recorded */
    for (int c = 0; c < 3; ++c)
        if (!event_values_agree(picture[c], events->events[events->count - 1].values[c]))
            return false;
    return true;
}

bool pixel_is_the_pictures(const struct pixel_report *report)
{
    return agrees(report->picture, &report->on_device) &&
           agrees(report->reference_picture, &report->reference);
}

const char *surface_name(const struct pixel_report *report, double surface)
{
    const struct packed_scene *packed = report->packed;
    int i = (int)surface, plane = i - packed->sphere_count;
    if (i < 0 || plane >= packed->plane_count)
        return "nothing";
    int file_order = plane < 0 ? packed->spheres[i].surface.tags.FILE_ORDER
                               : packed->planes[plane].surface.tags.FILE_ORDER;
    return report->scene->objects[file_order].name;
}

bool exact_knows(const struct event_field *field)
{
    return field->type != FIELD_VALUE || strcmp(field->name, "charge") != 0;
}

double unit_in_last_place(const struct reference_event *exact, const struct event_field *field, int component)
{
    double size = fabs(event_value(exact, field, component));
    if (size == 0)
        for (int c = 0; c < field->count; ++c)
            size = fmax(size, fabs(event_value(exact, field, c)));
    int exponent;
    frexp(size, &exponent);
    return ldexp(1, (exponent > FLT_MIN_EXP ? exponent : FLT_MIN_EXP) - FLT_MANT_DIG);
}

void print_bits(const struct pixel_report *report, double value, char text[static BITS_TEXT])
{
    if (report->precision == PRECISION_DOUBLE) {
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        snprintf(text, BITS_TEXT, "0x%016" PRIx64, bits);
        return;
    }
    float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    snprintf(text, BITS_TEXT, "0x%08" PRIx32, bits);
}
