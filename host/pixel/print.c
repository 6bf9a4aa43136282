#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "pixel/trace.h"

enum {
    DEEPEST_INDENT = 24,
    NAME_WIDTH = 16,
    LIGHT_RECEIVED = 5, /* of an EVENT_LIGHT's values */
    LIGHT_AREA = 6,
};

/* A walk through the device's steps. */
struct walk {
    const struct pixel_trace *trace;
    size_t at;
    struct step step; /* the one there; without the exact side where that went another way */
    int indent;
    int parted_at; /* the exact ray of so many bounces met another object than this one; INT_MAX: none did */
};

static void move_to(struct walk *walk, size_t i)
{
    walk->at = i;
    walk->step = walk->trace->steps[i];
    const layout_ivec4 place = walk->step.device->head.place;
    if (place.EVENT_KIND == EVENT_RAY && place.EVENT_BOUNCES <= walk->parted_at)
        walk->parted_at = INT_MAX;
    if (place.EVENT_BOUNCES >= walk->parted_at && place.EVENT_KIND < EVENT_SAMPLE)
        walk->step.exact = NULL;
}

/* Whether device and reference part first in this quantity of the device's step i; NULL: in the step itself.
 */
static bool is_first_difference(const struct pixel_trace *trace, size_t i, const struct event_field *field)
{
    const struct event_difference *difference = &trace->difference;
    return difference->differs && difference->event == i && difference->field == field;
}

static bool differs(const struct event_field *field, const struct reference_event *a,
                    const struct reference_event *b)
{
    return a && b && event_field_difference(field, a, b) >= 0;
}

static void print_value(const struct pixel_trace *trace, const struct event_field *field, double value)
{
    char text[NUMBER_TEXT], name[SURFACE_NAME];
    const char *const *names = field->names;
    if (field->type == FIELD_FLAG)
        fputs(value != 0 ? "yes" : "no", stdout);
    else if (field->type == FIELD_OBJECT)
        fputs(surface_name(trace, value, name), stdout);
    else if (names)
        fputs(value >= 0 && value < (double)MOST_EVENT_NAMES && names[(int)value] ? names[(int)value] : "?",
              stdout);
    else
        fputs(format_number(value / pow(trace->scale, field->metres), text), stdout);
}

static void print_values(const struct pixel_trace *trace, const struct event_field *field,
                         const struct reference_event *event)
{
    for (int c = 0; c < field->count; ++c) {
        if (c > 0)
            putchar(' ');
        print_value(trace, field, event_value(event, field, c));
    }
}

/* Float's unit in the last place of a component of the field's exact value; of its largest, if that is 0. */
static double unit_in_last_place(const struct reference_event *exact, const struct event_field *field,
                                 int component)
{
    double size = fabs(event_value(exact, field, component));
    if (size == 0)
        for (int c = 0; c < field->count; ++c)
            size = fmax(size, fabs(event_value(exact, field, c)));
    int exponent;
    frexp(size, &exponent);
    return ldexp(1, (exponent > FLT_MIN_EXP ? exponent : FLT_MIN_EXP) - FLT_MANT_DIG);
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

/* Marks the first difference: at the end of the line of the quantity, or without one in a line of its own. */
static void print_first_difference(const struct walk *walk)
{
    static const char *const components[] = {".x", ".y", ".z"};
    const struct pixel_trace *trace = walk->trace;
    const struct event_difference *difference = &trace->difference;
    const struct event_field *field = difference->field;
    const struct ray_tree *const sides[] = {&trace->device, &trace->reference};
    printf("%*s<-- first difference: %s%s", field ? 2 : walk->indent, "", field ? field->name : "step",
           field && field->count > 1 ? components[difference->component] : "");
    for (int i = 0; i < 2; ++i) {
        const struct reference_event *event = &sides[i]->events[difference->event];
        char bits[BITS_TEXT];
        fputs(i == 0 ? ", device " : ", reference ", stdout);
        if (difference_bits(trace, sides[i], bits))
            printf("%s ", bits);
        if (field)
            print_value(trace, field, event_value(event, field, difference->component));
        else
            fputs(difference->event < sides[i]->count ? event_name(event) : "has ended", stdout);
    }
    putchar('\n');
}

static void begin_line(const struct walk *walk, const char *name)
{
    printf("%*s%-*s ", walk->indent, "", NAME_WIDTH, name);
}

/* A line with one quantity; those of the other sides only where they differ. */
static void print_field(const struct walk *walk, const struct event_field *field)
{
    const struct pixel_trace *trace = walk->trace;
    const struct step *step = &walk->step;
    begin_line(walk, field->name);
    print_values(trace, field, step->device);
    if (differs(field, step->device, step->reference)) {
        fputs("  reference ", stdout);
        print_values(trace, field, step->reference);
    }
    if (step->exact && field->type == FIELD_VALUE && !field->not_analysed) {
        print_error(field, step);
    } else if (field->type != FIELD_VALUE && differs(field, step->device, step->exact)) {
        printf("  %s ", precision_name(trace->against));
        print_values(trace, field, step->exact);
    }
    if (is_first_difference(trace, walk->at, field))
        print_first_difference(walk);
    else
        putchar('\n');
}

/* The number of the quad light that an EVENT_LIGHT is about, from 1; below that, of none. */
static int quad_light(const struct walk *walk)
{
    return walk->step.device->head.facts.EVENT_OF_LIGHT - walk->trace->job->packed.point_light_count + 1;
}

static bool is_shown(const struct walk *walk, const struct event_field *field)
{
    const struct step *step = &walk->step;
    const bool followed = event_is_followed(step->device);
    return field->shown == SHOWN || (field->shown == SHOWN_IF_FOLLOWED && followed) ||
           (field->shown == SHOWN_OF_QUADS && followed && quad_light(walk) > 0) ||
           differs(field, step->device, step->reference) || is_first_difference(walk->trace, walk->at, field);
}

/* The step's quantities, and the margin of its decisions if there is an analysis. */
static void print_fields(struct walk *walk)
{
    const struct reference_event *device = walk->step.device, *exact = walk->step.exact;
    for (const struct event_field *field = NULL; (field = event_next_field(device, field));) {
        if (is_shown(walk, field))
            print_field(walk, field);
        if (device->head.place.EVENT_KIND == EVENT_HIT && field->type == FIELD_OBJECT &&
            differs(field, device, walk->step.exact)) {
            walk->parted_at = device->head.place.EVENT_BOUNCES;
            walk->step.exact = NULL;
        }
    }
    if (!exact || !isfinite(exact->margin))
        return;
    begin_line(walk, "margin");
    printf("%.3g%s\n", exact->margin, exact->margin < 1 ? "  float may decide otherwise" : "");
}

/* How the ray came about: its parent is the last one before it with a bounce less. */
static const char *describe_ray(const struct ray_tree *tree, const struct reference_event *ray)
{
    const layout_ivec4 place = ray->head.place;
    if (place.EVENT_BOUNCES == 0)
        return "primary ray";
    const struct reference_event *event = ray; /* then the last that became of the parent: a hit or a split */
    do
        --event;
    while (event > tree->events &&
           (event->head.place.EVENT_BOUNCES != place.EVENT_BOUNCES - 1 ||
            (event->head.place.EVENT_KIND != EVENT_HIT && event->head.place.EVENT_KIND != EVENT_SPLIT)));
    const uint32_t parent = (uint32_t)event->head.place.EVENT_BRANCH, branch = (uint32_t)place.EVENT_BRANCH;
    if (branch == 2 * parent + 1)
        return "refracted ray";
    if (branch == 2 * parent + 2)
        return "reflected ray";
    return event->head.place.EVENT_KIND == EVENT_SPLIT ? "totally reflected ray" : "mirrored ray";
}

static void print_ray_heading(struct walk *walk)
{
    const struct pixel_trace *trace = walk->trace;
    const struct reference_event *ray = walk->step.device;
    const int bounces = ray->head.place.EVENT_BOUNCES;
    char name[SURFACE_NAME];
    walk->indent = 2 * (bounces < DEEPEST_INDENT ? bounces : DEEPEST_INDENT);
    printf("%*s%s", walk->indent, "", describe_ray(&trace->device, ray));
    if (trace->job->packed.samples > 1)
        printf(", sample %d", ray->head.place.EVENT_OF_SAMPLE);
    if (bounces > 0)
        printf(", bounce %d, from %s", bounces, surface_name(trace, ray->head.facts.EVENT_SURFACE, name));
    if (!walk->step.reference)
        fputs("; the reference has no such ray", stdout);
    if (trace->against != PRECISION_FLOAT && !walk->step.exact)
        printf("; not in the exact tree (%s)", precision_name(trace->against));
    putchar('\n');
    walk->indent += 2;
}

static void print_step(struct walk *walk)
{
    const struct reference_event *event = walk->step.device;
    const layout_ivec4 facts = event->head.facts;
    const int quad = quad_light(walk);
    switch (event->head.place.EVENT_KIND) {
    case EVENT_RAY:
        print_ray_heading(walk);
        break;
    case EVENT_UNTRACED:
        printf("%*s", walk->indent, "");
        print_value(walk->trace, event_next_field(event, NULL), facts.EVENT_REASON);
        putchar('\n');
        break;
    case EVENT_LIGHT:
        if (quad > 0)
            printf("%*squad light %d, sample %d\n", walk->indent, "", quad, facts.EVENT_LIGHT_SAMPLE);
        else
            printf("%*spoint light %d\n", walk->indent, "", facts.EVENT_OF_LIGHT + 1);
        walk->indent += 2;
        print_fields(walk);
        walk->indent -= 2;
        return;
    case EVENT_SAMPLE:
        printf("sample %d\n", event->head.place.EVENT_OF_SAMPLE);
        walk->indent = 2;
        break;
    case EVENT_PIXEL:
        puts("pixel");
        walk->indent = 2;
        break;
    }
    print_fields(walk);
}

/* The samples of one quad light at one point, summed up, but for the one with the first difference. The walk
 * ends at the last. */
static void print_light_samples(struct walk *walk)
{
    const struct ray_tree *tree = &walk->trace->device;
    const struct event_difference *difference = &walk->trace->difference;
    const size_t start = walk->at;
    const struct EventHead *head = &tree->events[start].head;
    const int quad = quad_light(walk);
    size_t end = start, lit = 0, shadowed = 0, differing = 0;
    double sum = 0, margin = INFINITY;
    do {
        const struct reference_event *event = &tree->events[end];
        const double received = event->values[LIGHT_RECEIVED], area = event->values[LIGHT_AREA];
        bool differing_field = false;
        move_to(walk, end);
        shadowed += event->head.facts.EVENT_BLOCKER >= 0;
        lit += received > 0 && area > 0;
        sum += received > 0 && area > 0 ? received * area : 0;
        for (const struct event_field *field = NULL; (field = event_next_field(event, field));)
            differing_field |= differs(field, event, walk->step.reference);
        differing += differing_field;
        if (walk->step.exact)
            margin = fmin(margin, walk->step.exact->margin);
        ++end;
    } while (end < tree->count && !is_first_difference(walk->trace, end, NULL) &&
             memcmp(&tree->events[end].head.place, &head->place, sizeof head->place) == 0 &&
             tree->events[end].head.facts.EVENT_OF_LIGHT == head->facts.EVENT_OF_LIGHT);
    printf("%*squad light %d: %zu of %zu samples lit, %zu in shadow; sum of received x area %.6g",
           walk->indent, "", quad, lit, end - start, shadowed, sum);
    if (differing > 0)
        printf("; %zu differ from the reference", differing);
    if (isfinite(margin))
        printf("; margin %.3g", margin);
    putchar('\n');
    if (difference->field && difference->event >= start && difference->event < end) {
        move_to(walk, difference->event);
        print_step(walk);
    }
    walk->at = end - 1;
}

void pixel_print_verdict(const struct pixel_trace *trace)
{
    const struct event_difference *difference = &trace->difference;
    const double *picture = trace->picture;
    printf("%s: pixel (%u, %u): ", trace->job->scene.path, trace->job->plan.window.x,
           trace->job->plan.window.y);
    if (difference->differs)
        printf("DIFFERS, first in %s of step %zu\n", difference->field ? difference->field->name : "kind",
               difference->event + 1);
    else
        printf("device and reference agree in %zu steps\n", trace->device.count);
    if (trace->device.beyond > 0 || trace->reference.beyond > 0)
        printf("not recorded: %zu more steps of the device, %zu of the reference\n", trace->device.beyond,
               trace->reference.beyond);
    if (!trace->is_the_pictures)
        printf("the picture has %.9g %.9g %.9g here: not what was recorded\n", picture[0], picture[1],
               picture[2]);
}

void pixel_print(const struct pixel_trace *trace, bool all_light_samples)
{
    const struct render_plan *plan = &trace->job->plan;
    printf("%s: pixel (%u, %u) on %s, %s; metres\n", trace->job->scene.path, plan->window.x, plan->window.y,
           trace->context->properties.deviceName, precision_name(plan->precision));
    struct walk walk = {.trace = trace, .parted_at = INT_MAX};
    for (size_t i = 0; i < trace->device.count; i = walk.at + 1) {
        move_to(&walk, i);
        if (is_first_difference(trace, i, NULL))
            print_first_difference(&walk);
        if (walk.step.device->head.place.EVENT_KIND == EVENT_LIGHT && quad_light(&walk) > 0 &&
            !all_light_samples && trace->job->packed.light_samples > 1)
            print_light_samples(&walk);
        else
            print_step(&walk);
    }
    if (is_first_difference(trace, trace->device.count, NULL)) /* the device has ended early */
        print_first_difference(&walk);
    size_t missing = 0;
    for (const struct step *step = trace->steps + trace->device.count;
         step < trace->steps + trace->step_count; ++step)
        missing += step->reference && step->reference->head.place.EVENT_KIND == EVENT_RAY;
    if (trace->difference.differs && missing > 0)
        printf("the reference traces %zu rays that the device does not\n", missing);
}
