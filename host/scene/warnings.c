#include "scene/body.h"
#include "scene/overlap.h"

/* Whether the light shines on some point of a matte object; turned: with u and v swapped. */
static bool shines_on_any(const struct scene *scene, const struct scene_light *light, bool turned)
{
    struct dvec3 back = dvec3_unit(dvec3_cross(dvec3_of(light->quad.u), dvec3_of(light->quad.v)));
    struct dvec3 axis = dvec3_scale(turned ? 1 : -1, back);
    for (size_t i = 0; i < scene->body_count; ++i) {
        const struct body body = body_numbered(scene, i);
        if (scene->materials[body_find(scene, i).object->material].type != MATERIAL_MATTE)
            continue;
        struct dvec3 point = body.is_ball ? body.vector : dvec3_scale(body.number, body.vector);
        double reach = body.is_ball ? body.number : 0;
        if (!body.is_ball && dvec3_length(dvec3_cross(axis, body.vector)) > RESOLUTION)
            reach = INFINITY;
        if (dvec3_dot(axis, dvec3_subtract(point, dvec3_of(light->quad.corner))) + reach > 0)
            return true;
    }
    return false;
}

static void warn_of_lights(const struct scene *scene)
{
    for (size_t i = 0; i < scene->light_count; ++i) {
        const struct scene_light *light = &scene->lights[i];
        if (light->type != LIGHT_QUAD || shines_on_any(scene, light, false) ||
            !shines_on_any(scene, light, true))
            continue;
        log_warning(
            "%s:%d:%d: quad light shines away from every matte surface; swap u and v to turn it round",
            scene->path, light->place.line, light->place.column);
        return;
    }
}

void scene_warn(const struct scene *scene)
{
    overlaps_warn(scene);
    warn_of_lights(scene);
}
