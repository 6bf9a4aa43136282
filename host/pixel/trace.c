#include "pixel/trace.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/body.h"

enum { DEVICE, REFERENCE, EXACT, SIDES };

/* An event, whose it is and its place in that tree. */
struct entry {
    const struct reference_event *event;
    int side;
    size_t place;
};

/* Orders events by the step they tell of: its ray, its kind and, where a ray has several of that, its facts.
 */
static int compare_steps(const struct reference_event *a, const struct reference_event *b)
{
    const int order = memcmp(&a->head.place, &b->head.place, sizeof a->head.place);
    const int kind = a->head.place.EVENT_KIND;
    const bool several = kind == EVENT_LIGHT || kind == EVENT_UNTRACED;
    return order || !several ? order : memcmp(&a->head.facts, &b->head.facts, 2 * sizeof a->head.facts.x);
}

/* So too, then by place: branches wrap around after 32 bounces, and steps may share all of the above. */
static int compare_entries(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    const int order = compare_steps(p->event, q->event);
    return order ? order : (p->place > q->place) - (p->place < q->place);
}

static enum status find_steps(struct pixel_trace *trace)
{
    const struct ray_tree *trees[SIDES] = {&trace->device, &trace->reference, &trace->exact};
    trace->step_count = trace->device.count + trace->reference.count;
    const size_t total = trace->step_count + trace->exact.count;
    struct entry *entries = calloc(total + 1, sizeof *entries), *end = entries;
    trace->steps = calloc(trace->step_count + 1, sizeof *trace->steps);
    if (!entries || !trace->steps) {
        log_error("no memory for %zu events", total);
        free(entries);
        return STATUS_UNABLE;
    }
    for (int side = 0; side < SIDES; ++side)
        for (size_t i = 0; i < trees[side]->count; ++i)
            *end++ = (struct entry){&trees[side]->events[i], side, i};
    qsort(entries, total, sizeof *entries, compare_entries);
    for (const struct entry *entry = entries, *first; entry < end;) {
        const struct reference_event *same[SIDES] = {NULL};
        for (first = entry; entry < end && !same[entry->side] && !compare_steps(entry->event, first->event);
             ++entry)
            same[entry->side] = entry->event;
        const struct step step = {same[DEVICE], same[REFERENCE], same[EXACT]};
        if (step.device)
            trace->steps[step.device - trace->device.events] = step;
        else if (step.reference)
            trace->steps[trace->device.count + (size_t)(step.reference - trace->reference.events)] = step;
    }
    free(entries);
    return STATUS_DONE;
}

/* The pixel as the picture has it. */
static enum status render_pixel(struct vulkan_context *context, const struct render_plan *plan, double rgb[3])
{
    struct rendering rendering;
    enum status status = render_on_device(context, plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    const struct image *image = &rendering.image;
    for (int c = 0; c < 3; ++c)
        rgb[c] = image->rgb64 ? image->rgb64[c] : (double)image->rgb[c];
    image_destroy(&rendering.image);
    return STATUS_DONE;
}

/* Whether the device's tree ends in the picture's pixel; what was not recorded cannot tell. */
static bool is_the_pictures(const struct pixel_trace *trace)
{
    const struct ray_tree *tree = &trace->device;
    const struct reference_event *last = tree->count > 0 ? &tree->events[tree->count - 1] : NULL;
    if (!last || last->head.place.EVENT_KIND != EVENT_PIXEL)
        return tree->beyond > 0;
    bool agree = true;
    for (int c = 0; c < 3; ++c)
        agree = agree && event_values_agree(trace->picture[c], last->values[c]);
    return agree;
}

enum status pixel_trace_create(struct vulkan_context *context, const struct job *job, enum precision against,
                               struct pixel_trace *trace)
{
    const struct render_plan *plan = &job->plan;
    *trace = (struct pixel_trace){
        .job = job, .context = context, .against = against, .scale = pack_scale(&job->scene)};
    enum status status = ray_tree_on_cpu(plan, PRECISION_FLOAT, &trace->reference);
    if (status == STATUS_DONE && against != PRECISION_FLOAT)
        status = ray_tree_on_cpu(plan, against, &trace->exact);
    if (status == STATUS_DONE)
        status = ray_tree_on_device(context, plan, trace->reference.count + trace->reference.beyond + 1024,
                                    &trace->device);
    if (status == STATUS_DONE)
        status = render_pixel(context, plan, trace->picture);
    if (status == STATUS_DONE)
        status = find_steps(trace);
    trace->difference = ray_trees_compare(&trace->device, &trace->reference);
    trace->is_the_pictures = is_the_pictures(trace);
    if (status != STATUS_DONE)
        pixel_trace_destroy(trace);
    return status;
}

void pixel_trace_destroy(struct pixel_trace *trace)
{
    ray_tree_destroy(&trace->device);
    ray_tree_destroy(&trace->reference);
    ray_tree_destroy(&trace->exact);
    free(trace->steps);
    *trace = (struct pixel_trace){0};
}

const char *surface_name(const struct pixel_trace *trace, double surface, char text[static SURFACE_NAME])
{
    const struct packed_scene *packed = &trace->job->packed;
    if (surface < 0 || surface >= body_count(packed))
        return "nothing";
    const struct body_place place =
        body_find(&trace->job->scene, (size_t)body_file_order(packed, (int)surface));
    return place.object->type == OBJECT_SPHERES ? body_name(place, text) : place.object->name;
}

const char *difference_bits(const struct pixel_trace *trace, const struct ray_tree *side,
                            char text[static BITS_TEXT])
{
    const struct event_difference *difference = &trace->difference;
    if (!difference->field || difference->field->type != FIELD_VALUE)
        return NULL;
    const double value =
        event_value(&side->events[difference->event], difference->field, difference->component);
    uint64_t bits;
    uint32_t float_bits;
    memcpy(&bits, &value, sizeof bits);
    memcpy(&float_bits, &(float){(float)value}, sizeof float_bits);
    if (trace->job->plan.precision == PRECISION_DOUBLE)
        snprintf(text, BITS_TEXT, "0x%016" PRIx64, bits);
    else
        snprintf(text, BITS_TEXT, "0x%08" PRIx32, float_bits);
    return text;
}
