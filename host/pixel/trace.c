#include "pixel/trace.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Orders events by the step they tell of: its ray, its kind and, where a ray has several of that, its facts.
 */
static int compare_steps(const struct reference_event *a, const struct reference_event *b)
{
    const layout_ivec4 p = a->head.place, q = b->head.place, f = a->head.facts, g = b->head.facts;
    const int one[] = {p.EVENT_OF_SAMPLE, p.EVENT_BRANCH, p.EVENT_BOUNCES, p.EVENT_KIND, f.x, f.y};
    const int other[] = {q.EVENT_OF_SAMPLE, q.EVENT_BRANCH, q.EVENT_BOUNCES, q.EVENT_KIND, g.x, g.y};
    const bool several = p.EVENT_KIND == EVENT_LIGHT || p.EVENT_KIND == EVENT_UNTRACED;
    for (int i = 0; i < (several ? 6 : 4); ++i)
        if (one[i] != other[i])
            return one[i] < other[i] ? -1 : 1;
    return 0;
}

/* The same for pointers; equal ones by their order in the tree. */
static int compare_pointers(const void *a, const void *b)
{
    const struct reference_event *const *p = a, *const *q = b;
    int order = compare_steps(*p, *q);
    return order ? order : (*p > *q) - (*p < *q);
}

static int compare_references(const void *a, const void *b)
{
    const struct step *p = a, *q = b;
    return (p->reference > q->reference) - (p->reference < q->reference);
}

enum { SIDES = 3 };

/* Takes what tells of the same step from all sides, whose events are sorted. */
static void join_sides(const struct reference_event **sorted[SIDES], const size_t counts[SIDES],
                       struct pixel_trace *trace)
{
    size_t at[SIDES] = {0};
    for (;;) {
        const struct reference_event *first = NULL, *same[SIDES] = {NULL};
        for (int side = 0; side < SIDES; ++side)
            if (at[side] < counts[side] && (!first || compare_steps(sorted[side][at[side]], first) < 0))
                first = sorted[side][at[side]];
        if (!first)
            return;
        for (int side = 0; side < SIDES; ++side)
            if (at[side] < counts[side] && compare_steps(sorted[side][at[side]], first) == 0)
                same[side] = sorted[side][at[side]++];
        const struct step step = {same[0], same[1], same[2]};
        if (step.device)
            trace->steps[step.device - trace->device.events] = step;
        else if (step.reference)
            trace->steps[trace->step_count++] = step;
    }
}

static enum status find_steps(struct pixel_trace *trace)
{
    const struct ray_tree *trees[SIDES] = {&trace->device, &trace->reference, &trace->exact};
    const size_t counts[SIDES] = {trees[0]->count, trees[1]->count, trees[2]->count};
    const struct reference_event **sorted[SIDES];
    trace->step_count = counts[0];
    trace->steps = calloc(counts[0] + counts[1] + 1, sizeof *trace->steps);
    bool complete = trace->steps;
    for (int side = 0; side < SIDES; ++side) {
        sorted[side] = calloc(counts[side] + 1, sizeof *sorted[side]);
        complete = complete && sorted[side];
        for (size_t i = 0; complete && i < counts[side]; ++i)
            sorted[side][i] = &trees[side]->events[i];
        if (complete)
            qsort(sorted[side], counts[side], sizeof *sorted[side], compare_pointers);
    }
    if (complete) {
        join_sides(sorted, counts, trace);
        qsort(trace->steps + counts[0], trace->step_count - counts[0], sizeof *trace->steps,
              compare_references);
    } else {
        log_error("no memory for %zu events", counts[0] + counts[1] + counts[2]);
    }
    for (int side = 0; side < SIDES; ++side)
        free(sorted[side]);
    return complete ? STATUS_DONE : STATUS_UNABLE;
}

/* The pixel as the picture has it; the reference's without a context. */
static enum status render_pixel(struct vulkan_context *context, const struct render_plan *plan, double rgb[3])
{
    struct rendering rendering;
    enum status status =
        context ? render_on_device(context, plan, &rendering) : render_on_cpu(plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    const struct image *image = &rendering.image;
    for (int c = 0; c < 3; ++c)
        rgb[c] = image->rgb64 ? image->rgb64[c] : (double)image->rgb[c];
    image_destroy(&rendering.image);
    return STATUS_DONE;
}

/* Whether the tree ends in the picture's pixel; what was not recorded cannot tell. */
static bool ends_in(const struct ray_tree *tree, const double picture[3])
{
    const struct reference_event *last = tree->count > 0 ? &tree->events[tree->count - 1] : NULL;
    if (!last || last->head.place.EVENT_KIND != EVENT_PIXEL)
        return tree->beyond > 0;
    for (int c = 0; c < 3; ++c)
        if (!event_values_agree(picture[c], last->values[c]))
            return false;
    return true;
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
        status = render_pixel(NULL, plan, trace->reference_picture);
    if (status == STATUS_DONE)
        status = find_steps(trace);
    trace->difference = ray_trees_compare(&trace->device, &trace->reference);
    trace->is_the_pictures =
        ends_in(&trace->device, trace->picture) && ends_in(&trace->reference, trace->reference_picture);
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

const char *surface_name(const struct pixel_trace *trace, double surface)
{
    const struct packed_scene *packed = &trace->job->packed;
    int i = (int)surface, plane = i - packed->sphere_count;
    if (i < 0 || plane >= packed->plane_count)
        return "nothing";
    int file_order = plane < 0 ? packed->spheres[i].surface.tags.FILE_ORDER
                               : packed->planes[plane].surface.tags.FILE_ORDER;
    return trace->job->scene.objects[file_order].name;
}

void difference_bits(const struct pixel_trace *trace, const struct ray_tree *side,
                     char text[static BITS_TEXT])
{
    const struct event_difference *difference = &trace->difference;
    double value = event_value(&side->events[difference->event], difference->field, difference->component);
    float narrow = (float)value;
    uint64_t bits;
    uint32_t narrow_bits;
    memcpy(&bits, &value, sizeof bits);
    memcpy(&narrow_bits, &narrow, sizeof narrow_bits);
    if (trace->job->plan.precision == PRECISION_DOUBLE)
        snprintf(text, BITS_TEXT, "0x%016" PRIx64, bits);
    else
        snprintf(text, BITS_TEXT, "0x%08" PRIx32, narrow_bits);
}
