#include <math.h>
#include <stdlib.h>

#include "pixel/report.h"

/* JSON has no infinity. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

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

static json_t *field_json(const struct pixel_report *report, const struct event_field *field,
                          const struct reference_event *event, const double *values)
{
    if (field->type == FIELD_OBJECT)
        return json_string(surface_name(report, event_value(event, field, 0)));
    if (field->type == FIELD_FLAG)
        return json_boolean(event_value(event, field, 0) != 0);
    if (field->type == FIELD_NUMBER)
        return json_integer((json_int_t)event_value(event, field, 0));
    const double scale = pow(report->scale, field->metres);
    if (field->count == 1)
        return number(values[field->first] / scale);
    const double *first = values + field->first;
    return json_pack("[o, o, o]", number(first[0] / scale), number(first[1] / scale),
                     number(first[2] / scale));
}

static json_t *event_json(const struct pixel_report *report, const struct reference_event *event)
{
    json_t *object = json_object();
    for (const struct event_field *field = event_fields(event->head.place.x); field->name; ++field)
        object = with(object, field->name, field_json(report, field, event, event->values));
    return object;
}

/* Errors of the device's values, and bounds on them. */
static json_t *exact_json(const struct pixel_report *report, const struct reference_event *device,
                          const struct reference_event *exact)
{
    json_t *object = event_json(report, exact), *errors = json_object(), *bounds = json_object();
    struct reference_event error = *device;
    for (int i = 0; i < EVENT_VALUES; ++i)
        error.values[i] = device->values[i] - exact->values[i];
    for (const struct event_field *field = event_fields(device->head.place.x); field->name; ++field)
        if (field->type == FIELD_VALUE && exact_knows(field)) {
            errors = with(errors, field->name, field_json(report, field, &error, error.values));
            bounds = with(bounds, field->name, field_json(report, field, exact, exact->bounds));
        }
    return json_pack("{s:o, s:o, s:o, s:o}", "values", object, "errors", errors, "bounds", bounds, "margin",
                     number(exact->margin));
}

static json_t *step_json(const struct pixel_report *report, const struct reference_event *device,
                         const struct reference_event *reference, const struct reference_event *exact)
{
    const struct reference_event *event = device ? device : reference;
    const layout_ivec4 place = event->head.place;
    json_t *object = json_pack("{s:s, s:i, s:I, s:i}", "step", event_name(place.x), "sample", place.y,
                               "branch", (json_int_t)(uint32_t)place.z, "bounces", place.w);
    if (device)
        object = with(object, "device", event_json(report, device));
    if (reference)
        object = with(object, "reference", event_json(report, reference));
    if (exact && device)
        object = with(object, precision_name(report->against), exact_json(report, device, exact));
    return object;
}

/* STATUS_UNABLE is left to json_write() to report. */
static enum status append_steps(const struct pixel_report *report, json_t *steps)
{
    struct step_finder reference = {0}, exact = {0}, device = {0};
    enum status status = step_finder_create(&report->reference, &reference);
    if (status == STATUS_DONE)
        status = step_finder_create(&report->exact, &exact);
    if (status == STATUS_DONE)
        status = step_finder_create(&report->on_device, &device);
    for (size_t i = 0; status == STATUS_DONE && i < report->on_device.count; ++i) {
        const struct reference_event *event = &report->on_device.events[i];
        json_t *step = step_json(report, event, find_step(&reference, event), find_step(&exact, event));
        status = json_array_append_new(steps, step) == 0 ? STATUS_DONE : STATUS_UNABLE;
    }
    for (size_t i = 0; status == STATUS_DONE && i < report->reference.count; ++i) {
        const struct reference_event *event = &report->reference.events[i];
        if (!find_step(&device, event) &&
            json_array_append_new(steps, step_json(report, NULL, event, NULL)) != 0)
            status = STATUS_UNABLE;
    }
    free(reference.sorted);
    free(exact.sorted);
    free(device.sorted);
    return status;
}

static json_t *difference_json(const struct pixel_report *report)
{
    const struct event_difference *difference = &report->difference;
    const struct event_field *field = difference->field;
    if (!difference->differs)
        return json_null();
    json_t *object = json_pack("{s:I, s:s, s:i}", "step", (json_int_t)difference->event, "quantity",
                               field ? field->name : "step", "component", difference->component);
    if (!field || field->type != FIELD_VALUE)
        return object;
    char device[BITS_TEXT], reference[BITS_TEXT];
    print_bits(report,
               event_value(&report->on_device.events[difference->event], field, difference->component),
               device);
    print_bits(report,
               event_value(&report->reference.events[difference->event], field, difference->component),
               reference);
    object = with(object, "device_bits", json_string(device));
    object = with(object, "reference_bits", json_string(reference));
    return object;
}

json_t *pixel_json(const struct pixel_report *report)
{
    json_t *steps = json_array();
    if (append_steps(report, steps) != STATUS_DONE) {
        json_decref(steps);
        return NULL;
    }
    return json_pack("{s:s, s:s, s:s, s:s, s:i, s:i, s:b, s:o, s:f, s:[o,o,o], s:I, s:I, s:o}", "scene",
                     report->scene_path, "device", report->device, "driver", report->driver, "precision",
                     precision_name(report->precision), "x", (int)report->x, "y", (int)report->y, "agrees",
                     !report->difference.differs && pixel_is_the_pictures(report), "first_difference",
                     difference_json(report), "scene_units_per_metre", report->scale, "radiance",
                     number(report->picture[0]), number(report->picture[1]), number(report->picture[2]),
                     "steps_beyond_device", (json_int_t)report->on_device.beyond, "steps_beyond_reference",
                     (json_int_t)report->reference.beyond, "steps", steps);
}
