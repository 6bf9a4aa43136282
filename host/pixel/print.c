#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pixel/print_private.h"

enum { DEEPEST_INDENT = 24 };

static bool is_shown(const struct step *step, const struct event_field *field)
{
    const layout_ivec4 facts = step->device->head.facts;
    bool met = step->device->head.place.x != EVENT_HIT || facts.x >= 0;
    if (step->reference && !values_agree(field, step->device, step->reference))
        return true;
    switch (step->device->head.place.x) {
    case EVENT_RAY:
        return field->type == FIELD_VALUE;
    case EVENT_HIT:
        return met || field->type == FIELD_OBJECT;
    case EVENT_SPLIT:
        return facts.x == 0 || field->type == FIELD_FLAG || field->first == 3;
    case EVENT_LIGHT: /* the shadow ray's blocker and what comes through, if there is one */
        return field->first < 3 || field->first == 4 || facts.z == LIGHT_SHADOW_RAY;
    default:
        return true;
    }
}

static void print_fields(struct walk *walk, const struct step *step)
{
    struct step shown = *step;
    for (const struct event_field *field = event_fields(step->device->head.place.x); field->name; ++field) {
        if (is_shown(&shown, field))
            print_field(walk, &shown, field);
        if (shown.exact && field->type == FIELD_OBJECT && !values_agree(field, shown.device, shown.exact) &&
            step->device->head.place.x == EVENT_HIT) {
            walk->parted_at = step->device->head.place.w;
            shown.exact = NULL;
        }
    }
    print_margin(walk, step);
}

/* How the ray came about: its parent is the last one before it with a bounce less. */
static const char *describe_ray(const struct walk *walk, size_t i)
{
    const struct reference_event *events = walk->report->on_device.events;
    const layout_ivec4 place = events[i].head.place;
    if (place.w == 0)
        return "primary ray";
    while (i > 0 && !(events[i].head.place.x == EVENT_RAY && events[i].head.place.w == place.w - 1))
        --i;
    const uint32_t parent = (uint32_t)events[i].head.place.z, branch = (uint32_t)place.z;
    if (branch == 2 * parent + 1)
        return "refracted ray";
    if (branch == 2 * parent + 2)
        return "reflected ray";
    while (events[i].head.place.x != EVENT_HIT) /* of which there is one */
        ++i;
    return events[i + 1].head.place.x == EVENT_SPLIT ? "totally reflected ray" : "mirrored ray";
}

static void print_ray(struct walk *walk, const struct step *step)
{
    const layout_ivec4 place = step->device->head.place;
    walk->indent = place.w < DEEPEST_INDENT ? 2 * place.w : 2 * DEEPEST_INDENT;
    printf("%*s%s", walk->indent, "", describe_ray(walk, step->i));
    if (walk->report->packed->samples > 1)
        printf(", sample %d", place.y);
    if (place.w > 0)
        printf(", bounce %d, from %s", place.w, surface_name(walk->report, step->device->head.facts.x));
    if (!step->reference)
        fputs("; the reference has no such ray", stdout);
    if (walk->exact.events && !step->exact)
        printf("; not in the exact tree (%s)", precision_name(walk->report->against));
    putchar('\n');
    walk->indent += 2;
    print_fields(walk, step);
}

static void print_untraced(struct walk *walk, const struct step *step)
{
    static const char *const rays[] = {"reflected ray not traced", "refracted ray not traced",
                                       "no further ray: max_bounces", "no further ray: lost between mirrors"};
    int why = step->device->head.facts.x;
    printf("%*s%s\n", walk->indent, "", why >= 0 && why < 4 ? rays[why] : "?");
    for (const struct event_field *field = event_fields(EVENT_UNTRACED) + 1; field->name; ++field)
        print_field(walk, step, field);
}

static void print_light(struct walk *walk, const struct step *step)
{
    const struct packed_scene *packed = walk->report->packed;
    const layout_ivec4 facts = step->device->head.facts;
    const bool quad = facts.x >= packed->point_light_count;
    if (quad)
        printf("%*squad light %d, sample %d\n", walk->indent, "", facts.x - packed->point_light_count + 1,
               facts.y);
    else
        printf("%*spoint light %d\n", walk->indent, "", facts.x + 1);
    walk->indent += 2;
    for (const struct event_field *field = event_fields(EVENT_LIGHT) + 2; field->name; ++field)
        if (is_shown(step, field) && (quad || field->first != 6))
            print_field(walk, step, field);
    print_margin(walk, step);
    walk->indent -= 2;
}

static struct step step_at(struct walk *walk, size_t i)
{
    const struct reference_event *device = &walk->report->on_device.events[i];
    const layout_ivec4 place = device->head.place;
    struct step step = {
        .i = i,
        .device = device,
        .reference = find_step(&walk->reference, device),
        .exact = walk->exact.events ? find_step(&walk->exact, device) : NULL,
    };
    if (place.x == EVENT_RAY && place.w <= walk->parted_at)
        walk->parted_at = INT_MAX;
    if (place.w >= walk->parted_at && place.x < EVENT_SAMPLE)
        step.exact = NULL;
    return step;
}

static bool is_sample_of(const struct reference_event *event, const struct reference_event *first)
{
    return memcmp(&event->head.place, &first->head.place, sizeof event->head.place) == 0 &&
           event->head.facts.x == first->head.facts.x;
}

/* The samples of one quad light at one point, summed up, but for the one with the first difference. Returns
 * the number of the last. */
static size_t print_light_samples(struct walk *walk, size_t i)
{
    const struct pixel_events *events = &walk->report->on_device;
    const struct reference_event *first = &events->events[i];
    const struct event_difference *difference = &walk->report->difference;
    size_t end = i, lit = 0, shadowed = 0, differing = 0, first_difference = SIZE_MAX;
    double sum = 0, margin = INFINITY;
    for (; end < events->count && is_sample_of(&events->events[end], first); ++end) {
        struct step step = step_at(walk, end);
        double received = step.device->values[5], area = step.device->values[6];
        shadowed += step.device->head.facts.w >= 0;
        if (received > 0 && area > 0) {
            ++lit;
            sum += received * area;
        }
        for (const struct event_field *field = event_fields(EVENT_LIGHT); step.reference && field->name;
             ++field)
            if (!values_agree(field, step.device, step.reference)) {
                ++differing;
                break;
            }
        if (step.exact)
            margin = fmin(margin, step.exact->margin);
        if (difference->differs && difference->event == end)
            first_difference = end;
    }
    printf("%*squad light %d: %zu of %zu samples lit, %zu in shadow; sum of received x area %.6g",
           walk->indent, "", first->head.facts.x - walk->report->packed->point_light_count + 1, lit, end - i,
           shadowed, sum);
    if (differing > 0)
        printf("; %zu differ from the reference", differing);
    if (isfinite(margin))
        printf("; margin %.3g", margin);
    putchar('\n');
    if (first_difference != SIZE_MAX) {
        struct step step = step_at(walk, first_difference);
        print_light(walk, &step);
    }
    return end - 1;
}

static void print_other_step(struct walk *walk)
{
    const struct pixel_events *device = &walk->report->on_device, *reference = &walk->report->reference;
    const size_t i = walk->report->difference.event;
    printf("%*s<-- first difference: ", walk->indent, "");
    printf("step, device %s", i < device->count ? event_name(device->events[i].head.place.x) : "has ended");
    printf(", reference %s\n",
           i < reference->count ? event_name(reference->events[i].head.place.x) : "has ended");
    walk->marked = true;
}

static size_t print_events_from(struct walk *walk, size_t i)
{
    const struct event_difference *difference = &walk->report->difference;
    const layout_ivec4 place = walk->report->on_device.events[i].head.place;
    if (difference->differs && !difference->field && difference->event == i)
        print_other_step(walk);
    if (place.x == EVENT_LIGHT && !walk->all_light_samples && walk->report->packed->light_samples > 1 &&
        walk->report->on_device.events[i].head.facts.x >= walk->report->packed->point_light_count)
        return print_light_samples(walk, i);
    struct step step = step_at(walk, i);
    switch (place.x) {
    case EVENT_RAY:
        print_ray(walk, &step);
        break;
    case EVENT_UNTRACED:
        print_untraced(walk, &step);
        break;
    case EVENT_LIGHT:
        print_light(walk, &step);
        break;
    case EVENT_SAMPLE:
    case EVENT_PIXEL:
        walk->indent = 0;
        if (place.x == EVENT_PIXEL)
            puts("pixel");
        else
            printf("sample %d\n", place.y);
        walk->indent = 2;
        print_fields(walk, &step);
        break;
    default:
        print_fields(walk, &step);
    }
    return i;
}

/* Returns the number of the last event that the step is about. */
static size_t print_step(struct walk *walk, size_t i)
{
    const struct event_difference *difference = &walk->report->difference;
    size_t last = print_events_from(walk, i);
    if (!difference->differs || difference->event > last || walk->marked)
        return last;
    if (difference->field) { /* a quantity that is not shown otherwise */
        print_first_difference(walk);
        putchar('\n');
    } else {
        print_other_step(walk);
    }
    return last;
}

static enum status print_steps(struct walk *walk)
{
    const struct pixel_report *report = walk->report;
    enum status status = step_finder_create(&report->reference, &walk->reference);
    if (status == STATUS_DONE && report->against != PRECISION_FLOAT)
        status = step_finder_create(&report->exact, &walk->exact);
    if (status != STATUS_DONE)
        return status;
    for (size_t i = 0; i < report->on_device.count; ++i)
        i = print_step(walk, i);
    if (report->difference.differs && !walk->marked) /* the device has ended early */
        print_other_step(walk);
    return STATUS_DONE;
}

/* Rays that the reference traces and the device does not. */
static enum status print_missing_rays(const struct pixel_report *report)
{
    struct step_finder device;
    enum status status = step_finder_create(&report->on_device, &device);
    size_t missing = 0;
    for (size_t i = 0; status == STATUS_DONE && i < report->reference.count; ++i) {
        const struct reference_event *event = &report->reference.events[i];
        if (event->head.place.x == EVENT_RAY && !find_step(&device, event))
            ++missing;
    }
    if (missing > 0)
        printf("the reference traces %zu rays that the device does not\n", missing);
    free(device.sorted);
    return status;
}

void pixel_print_verdict(const struct pixel_report *report)
{
    const struct event_difference *difference = &report->difference;
    printf("%s: pixel (%u, %u): ", report->scene_path, report->x, report->y);
    if (difference->differs)
        printf("DIFFERS, first in %s of step %zu\n", difference->field ? difference->field->name : "kind",
               difference->event + 1);
    else
        printf("device and reference agree in %zu steps\n", report->on_device.count);
    if (report->on_device.beyond > 0 || report->reference.beyond > 0)
        printf("not recorded: %zu more steps of the device, %zu of the reference\n", report->on_device.beyond,
               report->reference.beyond);
    if (!pixel_is_the_pictures(report))
        printf("the picture has %.9g %.9g %.9g here, the reference's %.9g %.9g %.9g: not what was recorded\n",
               report->picture[0], report->picture[1], report->picture[2], report->reference_picture[0],
               report->reference_picture[1], report->reference_picture[2]);
}

enum status pixel_print(const struct pixel_report *report, bool all_light_samples)
{
    printf("%s: pixel (%u, %u) on %s, %s; metres\n", report->scene_path, report->x, report->y, report->device,
           precision_name(report->precision));
    struct walk walk = {.report = report, .all_light_samples = all_light_samples, .parted_at = INT_MAX};
    enum status status = print_steps(&walk);
    free(walk.reference.sorted);
    free(walk.exact.sorted);
    if (status == STATUS_DONE && report->difference.differs)
        status = print_missing_rays(report);
    return status;
}
