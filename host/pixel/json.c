#include <math.h>

#include "pixel/trace.h"

/* The object with a member more; NULL, and neither is left, without memory, where they may be NULL too. */
static json_t *with(json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) == 0)
        return object;
    json_decref(object);
    return NULL;
}

/* A quantity of the event; those of FIELD_VALUE come from values. */
static json_t *field_json(const struct pixel_trace *trace, const struct event_field *field,
                          const struct reference_event *event, const double *values)
{
    const double fact = event_value(event, field, 0), scale = pow(trace->scale, field->metres);
    char name[SURFACE_NAME];
    switch (field->type) {
    case FIELD_OBJECT:
        return json_string(surface_name(trace, fact, name));
    case FIELD_FLAG:
        return json_boolean(fact != 0);
    case FIELD_NUMBER:
        return json_integer((json_int_t)fact);
    case FIELD_VALUE:
        break;
    }
    values += field->first;
    if (field->count == 1)
        return json_real_or_null(values[0] / scale);
    return json_pack("[o, o, o]", json_real_or_null(values[0] / scale), json_real_or_null(values[1] / scale),
                     json_real_or_null(values[2] / scale));
}

/* The event's fields; with values_only just those of FIELD_VALUE that are analysed. */
static json_t *event_json(const struct pixel_trace *trace, const struct reference_event *event,
                          const double *values, bool values_only)
{
    json_t *object = json_object();
    for (const struct event_field *field = NULL; (field = event_next_field(event, field));)
        if (!values_only || (field->type == FIELD_VALUE && !field->not_analysed))
            object = with(object, field->name, field_json(trace, field, event, values));
    return object;
}

/* The exact values, the errors of the device's, and the bounds on them. */
static json_t *exact_json(const struct pixel_trace *trace, const struct step *step)
{
    const struct reference_event *exact = step->exact;
    double errors[EVENT_VALUES];
    for (int i = 0; i < EVENT_VALUES; ++i)
        errors[i] = step->device->values[i] - exact->values[i];
    return json_pack("{s:o, s:o, s:o, s:o}", "values", event_json(trace, exact, exact->values, false),
                     "errors", event_json(trace, exact, errors, true), "bounds",
                     event_json(trace, exact, exact->bounds, true), "margin",
                     json_real_or_null(exact->margin));
}

static json_t *step_json(const struct pixel_trace *trace, const struct step *step)
{
    const struct reference_event *event = step->device ? step->device : step->reference;
    const layout_ivec4 place = event->head.place;
    json_t *object =
        json_pack("{s:s, s:i, s:I, s:i}", "step", event_name(event), "sample", place.EVENT_OF_SAMPLE,
                  "branch", (json_int_t)(uint32_t)place.EVENT_BRANCH, "bounces", place.EVENT_BOUNCES);
    if (step->device)
        object = with(object, "device", event_json(trace, step->device, step->device->values, false));
    if (step->reference)
        object =
            with(object, "reference", event_json(trace, step->reference, step->reference->values, false));
    if (step->device && step->exact)
        object = with(object, precision_name(trace->against), exact_json(trace, step));
    return object;
}

static json_t *difference_json(const struct pixel_trace *trace)
{
    const struct event_difference *difference = &trace->difference;
    const struct event_field *field = difference->field;
    char device[BITS_TEXT], reference[BITS_TEXT];
    if (!difference->differs)
        return json_null();
    return json_pack("{s:I, s:s, s:i, s:s*, s:s*}", "step", (json_int_t)difference->event, "quantity",
                     field ? field->name : "step", "component", difference->component, "device_bits",
                     difference_bits(trace, &trace->device, device), "reference_bits",
                     difference_bits(trace, &trace->reference, reference));
}

json_t *pixel_json(const struct pixel_trace *trace)
{
    const struct render_plan *plan = &trace->job->plan;
    json_t *steps = json_array();
    for (size_t i = 0; i < trace->step_count; ++i)
        if ((trace->steps[i].device || trace->steps[i].reference) &&
            json_array_append_new(steps, step_json(trace, &trace->steps[i])) != 0) {
            json_decref(steps);
            return NULL;
        }
    return json_pack("{s:s, s:s, s:s, s:s, s:i, s:i, s:b, s:o, s:f, s:[o,o,o], s:I, s:I, s:o}", "scene",
                     trace->job->scene.path, "device", trace->context->properties.deviceName, "driver",
                     trace->context->driver.driverInfo, "precision", precision_name(plan->precision), "x",
                     (int)plan->window.x, "y", (int)plan->window.y, "agrees",
                     !trace->difference.differs && trace->is_the_pictures, "first_difference",
                     difference_json(trace), "scene_units_per_metre", trace->scale, "radiance",
                     json_real_or_null(trace->picture[0]), json_real_or_null(trace->picture[1]),
                     json_real_or_null(trace->picture[2]), "steps_beyond_device",
                     (json_int_t)trace->device.beyond, "steps_beyond_reference",
                     (json_int_t)trace->reference.beyond, "steps", steps);
}
