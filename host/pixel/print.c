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
    int indent;
    int parted_at; /* the exact ray of so many bounces met another object than this one; INT_MAX: none did */
};

static void print_value(const struct pixel_trace *trace, const struct event_field *field, double value)
{
    char text[NUMBER_TEXT];
    const char *const *names = field->names;
    if (field->type == FIELD_FLAG)
        fputs(value != 0 ? "yes" : "no", stdout);
    else if (field->type == FIELD_OBJECT)
        fputs(surface_name(trace, value), stdout);
    else if (names)
        fputs(value >= 0 && value < MOST_EVENT_NAMES && names[(int)value] ? names[(int)value] : "?", stdout);
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
        if (field && field->type == FIELD_VALUE)
            printf("%s ", difference_bits(trace, sides[i], bits));
        if (field)
            print_value(trace, field, event_value(event, field, difference->component));
        else
            fputs(difference->event < sides[i]->count ? event_name(event) : "has ended", stdout);
    }
    putchar('\n');
}

static bool is_first_difference(const struct walk *walk, const struct step *step,
                                const struct event_field *field)
{
    const struct event_difference *difference = &walk->trace->difference;
    return difference->field == field && step->device == &walk->trace->device.events[difference->event];
}

static void begin_line(const struct walk *walk, const char *name)
{
    printf("%*s%-*s ", walk->indent, "", NAME_WIDTH, name);
}

/* A line with one quantity; those of the other sides only where they differ. */
static void print_field(struct walk *walk, const struct step *step, const struct event_field *field)
{
    const struct pixel_trace *trace = walk->trace;
    begin_line(walk, field->name);
    print_values(trace, field, step->device);
    if (step->reference && !event_field_agrees(field, step->device, step->reference, NULL)) {
        fputs("  reference ", stdout);
        print_values(trace, field, step->reference);
    }
    if (step->exact && field->type == FIELD_VALUE && !field->not_analysed) {
        print_error(field, step);
    } else if (step->exact && field->type != FIELD_VALUE &&
               !event_field_agrees(field, step->device, step->exact, NULL)) {
        printf("  %s ", precision_name(trace->against));
        print_values(trace, field, step->exact);
    }
    if (is_first_difference(walk, step, field))
        print_first_difference(walk);
    else
        putchar('\n');
}

/* The number of the quad light that an EVENT_LIGHT is about, from 1; below that, of none. */
static int quad_light(const struct walk *walk, const struct reference_event *event)
{
    return event->head.facts.EVENT_OF_LIGHT - walk->trace->job->packed.point_light_count + 1;
}

static bool is_shown(const struct walk *walk, const struct step *step, const struct event_field *field)
{
    const bool followed = event_is_followed(step->device);
    return field->shown == SHOWN || (field->shown == SHOWN_IF_FOLLOWED && followed) ||
           (field->shown == SHOWN_OF_QUADS && followed && quad_light(walk, step->device) > 0) ||
           (step->reference && !event_field_agrees(field, step->device, step->reference, NULL)) ||
           is_first_difference(walk, step, field);
}

/* The step's quantities, and the margin of its decisions if there is an analysis. */
static void print_fields(struct walk *walk, const struct step *step)
{
    struct step shown = *step;
    const layout_ivec4 place = step->device->head.place;
    for (const struct event_field *field = NULL; (field = event_next_field(step->device, field));) {
        if (is_shown(walk, &shown, field))
            print_field(walk, &shown, field);
        if (place.EVENT_KIND == EVENT_HIT && field->type == FIELD_OBJECT && shown.exact &&
            !event_field_agrees(field, shown.device, shown.exact, NULL)) {
            walk->parted_at = place.EVENT_BOUNCES;
            shown.exact = NULL;
        }
    }
    if (!step->exact || !isfinite(step->exact->margin))
        return;
    begin_line(walk, "margin");
    printf("%.3g%s\n", step->exact->margin, step->exact->margin < 1 ? "  float may decide otherwise" : "");
}

/* How the ray came about: its parent is the last one before it with a bounce less. */
static const char *describe_ray(const struct ray_tree *tree, const struct reference_event *ray)
{
    const layout_ivec4 place = ray->head.place;
    const struct reference_event *event = ray;
    if (place.EVENT_BOUNCES == 0)
        return "primary ray";
    while (event > tree->events && (event->head.place.EVENT_KIND != EVENT_RAY ||
                                    event->head.place.EVENT_BOUNCES != place.EVENT_BOUNCES - 1))
        --event;
    const uint32_t parent = (uint32_t)event->head.place.EVENT_BRANCH, branch = (uint32_t)place.EVENT_BRANCH;
    if (branch == 2 * parent + 1)
        return "refracted ray";
    if (branch == 2 * parent + 2)
        return "reflected ray";
    while (event < ray && event->head.place.EVENT_KIND != EVENT_HIT)
        ++event;
    return event < ray && event[1].head.place.EVENT_KIND == EVENT_SPLIT ? "totally reflected ray"
                                                                        : "mirrored ray";
}

static void print_ray_heading(struct walk *walk, const struct step *step)
{
    const struct pixel_trace *trace = walk->trace;
    const layout_ivec4 place = step->device->head.place;
    const int bounces = place.EVENT_BOUNCES;
    walk->indent = 2 * (bounces < DEEPEST_INDENT ? bounces : DEEPEST_INDENT);
    printf("%*s%s", walk->indent, "", describe_ray(&trace->device, step->device));
    if (trace->job->packed.samples > 1)
        printf(", sample %d", place.EVENT_OF_SAMPLE);
    if (bounces > 0)
        printf(", bounce %d, from %s", bounces, surface_name(trace, step->device->head.facts.EVENT_SURFACE));
    if (!step->reference)
        fputs("; the reference has no such ray", stdout);
    if (trace->against != PRECISION_FLOAT && !step->exact)
        printf("; not in the exact tree (%s)", precision_name(trace->against));
    putchar('\n');
    walk->indent += 2;
}

static void print_step(struct walk *walk, struct step step)
{
    const struct reference_event *event = step.device;
    const layout_ivec4 facts = event->head.facts;
    const int kind = event->head.place.EVENT_KIND, quad = quad_light(walk, event);
    switch (kind) {
    case EVENT_RAY:
        print_ray_heading(walk, &step);
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
        break;
    case EVENT_SAMPLE:
        printf("sample %d\n", event->head.place.EVENT_OF_SAMPLE);
        walk->indent = 2;
        break;
    case EVENT_PIXEL:
        puts("pixel");
        walk->indent = 2;
        break;
    }
    walk->indent += kind == EVENT_LIGHT ? 2 : 0;
    print_fields(walk, &step);
    walk->indent -= kind == EVENT_LIGHT ? 2 : 0;
}

/* The step; without the exact side where that went another way. */
static struct step step_at(struct walk *walk, size_t i)
{
    struct step step = walk->trace->steps[i];
    const layout_ivec4 place = step.device->head.place;
    if (place.EVENT_KIND == EVENT_RAY && place.EVENT_BOUNCES <= walk->parted_at)
        walk->parted_at = INT_MAX;
    if (place.EVENT_BOUNCES >= walk->parted_at && place.EVENT_KIND < EVENT_SAMPLE)
        step.exact = NULL;
    return step;
}

static bool differs(const struct step *step)
{
    const struct event_field *field = NULL;
    while (step->reference && (field = event_next_field(step->device, field)))
        if (!event_field_agrees(field, step->device, step->reference, NULL))
            return true;
    return false;
}

/* Whether the trees part in the step itself, not in a quantity of it. */
static bool parts_at(const struct pixel_trace *trace, size_t i)
{
    return trace->difference.differs && !trace->difference.field && trace->difference.event == i;
}

/* The samples of one quad light at one point, summed up, but for the one with the first difference. Returns
 * the number of the last. */
static size_t print_light_samples(struct walk *walk, size_t i)
{
    const struct ray_tree *tree = &walk->trace->device;
    const struct event_difference *difference = &walk->trace->difference;
    const struct EventHead *head = &tree->events[i].head;
    size_t end = i, lit = 0, shadowed = 0, differing = 0;
    double sum = 0, margin = INFINITY;
    do {
        const struct reference_event *event = &tree->events[end];
        const struct step step = step_at(walk, end);
        const double received = event->values[LIGHT_RECEIVED], area = event->values[LIGHT_AREA];
        shadowed += event->head.facts.EVENT_BLOCKER >= 0;
        if (received > 0 && area > 0) {
            ++lit;
            sum += received * area;
        }
        differing += differs(&step);
        if (step.exact)
            margin = fmin(margin, step.exact->margin);
        ++end;
    } while (end < tree->count && !parts_at(walk->trace, end) &&
             memcmp(&tree->events[end].head.place, &head->place, sizeof head->place) == 0 &&
             tree->events[end].head.facts.EVENT_OF_LIGHT == head->facts.EVENT_OF_LIGHT);
    printf("%*squad light %d: %zu of %zu samples lit, %zu in shadow; sum of received x area %.6g",
           walk->indent, "", quad_light(walk, &tree->events[i]), lit, end - i, shadowed, sum);
    if (differing > 0)
        printf("; %zu differ from the reference", differing);
    if (isfinite(margin))
        printf("; margin %.3g", margin);
    putchar('\n');
    if (difference->field && difference->event >= i && difference->event < end)
        print_step(walk, step_at(walk, difference->event));
    return end - 1;
}

void pixel_print_verdict(const struct pixel_trace *trace)
{
    const struct event_difference *difference = &trace->difference;
    const double *picture = trace->picture, *reference = trace->reference_picture;
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
        printf("the picture has %.9g %.9g %.9g here, the reference's %.9g %.9g %.9g: not what was recorded\n",
               picture[0], picture[1], picture[2], reference[0], reference[1], reference[2]);
}

void pixel_print(const struct pixel_trace *trace, bool all_light_samples)
{
    const struct render_plan *plan = &trace->job->plan;
    printf("%s: pixel (%u, %u) on %s, %s; metres\n", trace->job->scene.path, plan->window.x, plan->window.y,
           trace->context->properties.deviceName, precision_name(plan->precision));
    struct walk walk = {.trace = trace, .parted_at = INT_MAX};
    for (size_t i = 0; i < trace->device.count; ++i) {
        const struct reference_event *event = &trace->device.events[i];
        if (parts_at(trace, i))
            print_first_difference(&walk);
        if (event->head.place.EVENT_KIND == EVENT_LIGHT && quad_light(&walk, event) > 0 &&
            !all_light_samples && trace->job->packed.light_samples > 1)
            i = print_light_samples(&walk, i);
        else
            print_step(&walk, step_at(&walk, i));
    }
    if (parts_at(trace, trace->device.count)) /* the device has ended early */
        print_first_difference(&walk);
    size_t missing = 0;
    for (size_t i = trace->device.count; i < trace->step_count; ++i)
        missing += trace->steps[i].reference->head.place.EVENT_KIND == EVENT_RAY;
    if (trace->difference.differs && missing > 0)
        printf("the reference traces %zu rays that the device does not\n", missing);
}
