#include <math.h>

#include "pixel/trace.h"

/* The object with a member more; NULL, and neither is left, without memory. */
static json_t *with(json_t *object, const char *key, json_t *value)
{
    if (object && json_object_set_new(object, key, value) == 0)
        return object;
    if (!object)
        json_decref(value);
    json_decref(object);
    return NULL;
}

/* A quantity of the event; the numbers of FIELD_VALUE come from values. */
static json_t *field_json(const struct pixel_trace *trace, const struct event_field *field,
                          const struct reference_event *event, const double *values)
{
    const double fact = event_value(event, field, 0), scale = pow(trace->scale, field->metres);
    switch (field->type) {
    case FIELD_OBJECT:
        return json_string(surface_name(trace, fact));
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

static json_t *event_json(const struct pixel_trace *trace, const struct reference_event *event)
{
    json_t *object = json_object();
    for (const struct event_field *field = NULL; (field = event_next_field(event, field));)
        object = with(object, field->name, field_json(trace, field, event, event->values));
    return object;
}

/* The exact values, the errors of the device's, and the bounds on them. */
static json_t *exact_json(const struct pixel_trace *trace, const struct step *step)
{
    const struct reference_event *exact = step->exact;
    json_t *errors = json_object(), *bounds = json_object();
    double error[EVENT_VALUES];
    for (int i = 0; i < EVENT_VALUES; ++i)
        error[i] = step->device->values[i] - exact->values[i];
    for (const struct event_field *field = NULL; (field = event_next_field(exact, field));)
        if (field->type == FIELD_VALUE && !field->not_analysed) {
            errors = with(errors, field->name, field_json(trace, field, exact, error));
            bounds = with(bounds, field->name, field_json(trace, field, exact, exact->bounds));
        }
    return json_pack("{s:o, s:o, s:o, s:o}", "values", event_json(trace, exact), "errors", errors, "bounds",
                     bounds, "margin", json_real_or_null(exact->margin));
}

static json_t *step_json(const struct pixel_trace *trace, const struct step *step)
{
    const struct reference_event *event = step->device ? step->device : step->reference;
    const layout_ivec4 place = event->head.place;
    json_t *object =
        json_pack("{s:s, s:i, s:I, s:i}", "step", event_name(event), "sample", place.EVENT_OF_SAMPLE,
                  "branch", (json_int_t)(uint32_t)place.EVENT_BRANCH, "bounces", place.EVENT_BOUNCES);
    if (step->device)
        object = with(object, "device", event_json(trace, step->device));
    if (step->reference)
        object = with(object, "reference", event_json(trace, step->reference));
    if (step->device && step->exact)
        object = with(object, precision_name(trace->against), exact_json(trace, step));
    return object;
}

static json_t *difference_json(const struct pixel_trace *trace)
{
    const struct event_difference *difference = &trace->difference;
    const struct event_field *field = difference->field;
    if (!difference->differs)
        return json_null();
    json_t *object = json_pack("{s:I, s:s, s:i}", "step", (json_int_t)difference->event, "quantity",
                               field ? field->name : "step", "component", difference->component);
    if (!field || field->type != FIELD_VALUE)
        return object;
    char bits[BITS_TEXT];
    object = with(object, "device_bits", json_string(difference_bits(trace, &trace->device, bits)));
    return with(object, "reference_bits", json_string(difference_bits(trace, &trace->reference, bits)));
}

json_t *pixel_json(const struct pixel_trace *trace)
{
    const struct render_plan *plan = &trace->job->plan;
    json_t *steps = json_array();
    for (size_t i = 0; i < trace->step_count; ++i)
        if (json_array_append_new(steps, step_json(trace, &trace->steps[i])) != 0) {
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
