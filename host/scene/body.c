#include "scene/body.h"

#include <stdio.h>

struct body_place body_find(const struct scene *scene, size_t number)
{
    size_t object = 0, behind = scene->object_count;
    while (behind - object > 1) {
        const size_t middle = object + (behind - object) / 2;
        if (scene->objects[middle].first <= number)
            object = middle;
        else
            behind = middle;
    }
    return (struct body_place){&scene->objects[object], number - scene->objects[object].first};
}

struct body body_numbered(const struct scene *scene, size_t number)
{
    const struct body_place place = body_find(scene, number);
    const struct scene_object *object = place.object;
    if (object->type == OBJECT_SPHERES) {
        const float *at = object->spheres.rows[place.row];
        return (struct body){true, {(double)at[0], (double)at[1], (double)at[2]}, (double)at[3], false};
    }
    if (object->type == OBJECT_SPHERE)
        return (struct body){true, dvec3_of(object->sphere.center), object->sphere.radius, false};
    struct dvec3 normal = dvec3_unit(dvec3_of(object->plane.normal));
    return (struct body){false, normal, dvec3_dot(normal, dvec3_of(object->plane.point)), false};
}

void body_visit(const struct packed_scene *packed, struct box box, hierarchy_visitor *visit, void *user)
{
    bool more = true;
    for (int i = 0; i < packed->looped_spheres && more; ++i)
        more = visit(user, (uint32_t)i);
    for (int i = packed->sphere_count; i < body_count(packed) && more; ++i)
        more = visit(user, (uint32_t)i);
    if (packed->hierarchy && more)
        hierarchy_visit(packed->hierarchy, box, visit, user);
}

const char *body_name(struct body_place place, char text[static BODY_NAME])
{
    const int length = snprintf(text, BODY_NAME, "\"%s\"", place.object->name);
    if (place.object->type == OBJECT_SPHERES)
        snprintf(text + length, (size_t)(BODY_NAME - length), " row %zu", place.row);
    return text;
}
