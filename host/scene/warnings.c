#include "scene/warnings.h"

#include <stdio.h>
#include <stdlib.h>

#include "scene/body.h"

/* Whether the surfaces of two bodies cross, or coincide with both bodies on the same side. */
static bool overlap(const struct scene_object *first, const struct scene_object *second)
{
    struct body a = body_of(first), b = body_of(second);
    if (!a.is_ball && !b.is_ball)
        return dvec3_length(dvec3_cross(a.vector, b.vector)) > RESOLUTION ||
               (dvec3_dot(a.vector, b.vector) > 0 &&
                fabs(a.number - b.number) <= RESOLUTION * fabs(b.number));
    bool a_is_smaller = a.is_ball && (!b.is_ball || a.number <= b.number);
    struct body ball = a_is_smaller ? a : b, other = a_is_smaller ? b : a;
    double touching = RESOLUTION * (dvec3_length(ball.vector) + ball.number);
    bool coincide = other.is_ball && other.number - ball.number <= touching &&
                    dvec3_distance(other.vector, ball.vector) <= touching;
    return coincide || body_reaches_into(other, ball);
}

static double lower_end(const struct scene_object *body, int axis)
{
    return body->type == OBJECT_SPHERE ? body->sphere.center[axis] - body->sphere.radius : -INFINITY;
}

static double upper_end(const struct scene_object *body, int axis)
{
    return body->type == OBJECT_SPHERE ? body->sphere.center[axis] + body->sphere.radius : INFINITY;
}

static bool apart(const struct scene_object *a, const struct scene_object *b, int axis)
{
    return lower_end(a, axis) > upper_end(b, axis) || lower_end(b, axis) > upper_end(a, axis);
}

static int compare_lower_ends(const void *a, const void *b)
{
    double first = lower_end(*(const struct scene_object *const *)a, 0);
    double second = lower_end(*(const struct scene_object *const *)b, 0);
    return (first > second) - (first < second);
}

/* The pairs of bodies that overlap. In the first one, the second body stands first in the file. */
struct overlaps {
    size_t count;
    const struct scene_object *a, *b;
};

static void count_overlap(struct overlaps *overlaps, const struct scene_object *a,
                          const struct scene_object *b)
{
    const struct scene_object *earlier = a < b ? a : b, *later = a < b ? b : a;
    if (overlaps->count++ == 0 || later < overlaps->b || (later == overlaps->b && earlier < overlaps->a)) {
        overlaps->a = earlier;
        overlaps->b = later;
    }
}

/* Sweeps along x: only bodies are compared that have some x in common. */
static bool find_overlaps(const struct scene *scene, struct overlaps *overlaps)
{
    const struct scene_object **bodies = calloc(scene->object_count + 1, sizeof *bodies);
    size_t count = 0;
    if (!bodies)
        return false;
    for (size_t i = 0; i < scene->object_count; ++i)
        if (scene->materials[scene->objects[i].material].type == MATERIAL_TRANSPARENT)
            bodies[count++] = &scene->objects[i];
    qsort(bodies, count, sizeof *bodies, compare_lower_ends);
    for (size_t i = 0; i < count; ++i)
        for (size_t k = i + 1; k < count && !apart(bodies[i], bodies[k], 0); ++k)
            if (!apart(bodies[i], bodies[k], 1) && !apart(bodies[i], bodies[k], 2) &&
                overlap(bodies[i], bodies[k]))
                count_overlap(overlaps, bodies[i], bodies[k]);
    free(bodies);
    return true;
}

static void warn_of_overlaps(const struct scene *scene)
{
    struct overlaps found = {0};
    char others[64] = "";
    if (!find_overlaps(scene, &found))
        log_warning("%s: no memory to look for transparent bodies that overlap", scene->path);
    if (found.count == 0)
        return;
    if (found.count > 1)
        snprintf(others, sizeof others, " (and %zu other pair%s)", found.count - 1,
                 found.count > 2 ? "s" : "");
    log_warning(
        "%s:%d:%d: transparent bodies \"%s\" and \"%s\" overlap%s, which the model does not cover; a "
        "body wholly inside another is no mistake, if its ior is relative to that one's (air in glass: "
        "1/1.5)",
        scene->path, found.b->place.line, found.b->place.column, found.a->name, found.b->name, others);
}

/* Whether the light shines on some point of a matte object, with u and v as they are or swapped. */
static bool shines_on_any(const struct scene *scene, const struct scene_light *light, bool swapped)
{
    struct dvec3 back = dvec3_unit(dvec3_cross(dvec3_of(light->quad.u), dvec3_of(light->quad.v)));
    struct dvec3 axis = dvec3_scale(swapped ? 1 : -1, back);
    for (size_t i = 0; i < scene->object_count; ++i) {
        const struct scene_object *object = &scene->objects[i];
        bool sphere = object->type == OBJECT_SPHERE;
        struct dvec3 point = dvec3_of(sphere ? object->sphere.center : object->plane.point);
        double height = dvec3_dot(axis, dvec3_subtract(point, dvec3_of(light->quad.corner)));
        if (scene->materials[object->material].type != MATERIAL_MATTE)
            continue;
        if (height + (sphere ? object->sphere.radius : 0) > 0)
            return true;
        if (!sphere &&
            dvec3_length(dvec3_cross(axis, dvec3_unit(dvec3_of(object->plane.normal)))) > RESOLUTION)
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
    warn_of_overlaps(scene);
    warn_of_lights(scene);
}
