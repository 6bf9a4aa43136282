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

static double lower_end(const struct scene_object *body)
{
    return body->type == OBJECT_SPHERE ? body->sphere.center[0] - body->sphere.radius : -INFINITY;
}

static int compare_lower_ends(const void *a, const void *b)
{
    double first = lower_end(*(const struct scene_object *const *)a);
    double second = lower_end(*(const struct scene_object *const *)b);
    return (first > second) - (first < second);
}

static bool apart(const struct scene_object *a, const struct scene_object *b, int axis)
{
    return a->type == OBJECT_SPHERE && b->type == OBJECT_SPHERE &&
           fabs(a->sphere.center[axis] - b->sphere.center[axis]) > a->sphere.radius + b->sphere.radius;
}

/* Sweeps along x: only bodies are compared that have some x in common. Of the first pair in the file, *later
 * is the one that stands last. */
static size_t count_overlaps(const struct scene *scene, const struct scene_object **bodies,
                             const struct scene_object **earlier, const struct scene_object **later)
{
    size_t count = 0, overlaps = 0;
    for (size_t i = 0; i < scene->object_count; ++i)
        if (scene->materials[scene->objects[i].material].type == MATERIAL_TRANSPARENT)
            bodies[count++] = &scene->objects[i];
    qsort(bodies, count, sizeof *bodies, compare_lower_ends);
    for (size_t i = 0; i < count; ++i)
        for (size_t k = i + 1; k < count && !apart(bodies[i], bodies[k], 0); ++k) {
            if (apart(bodies[i], bodies[k], 1) || apart(bodies[i], bodies[k], 2) ||
                !overlap(bodies[i], bodies[k]))
                continue;
            bool in_order = bodies[i] < bodies[k];
            const struct scene_object *a = bodies[in_order ? i : k], *b = bodies[in_order ? k : i];
            if (overlaps++ == 0 || b < *later || (b == *later && a < *earlier)) {
                *earlier = a;
                *later = b;
            }
        }
    return overlaps;
}

static void warn_of_overlaps(const struct scene *scene)
{
    const struct scene_object **bodies = calloc(scene->object_count + 1, sizeof *bodies);
    const struct scene_object *a = NULL, *b = NULL;
    char others[64] = "";
    if (!bodies)
        log_warning("%s: no memory to look for transparent bodies that overlap", scene->path);
    size_t count = bodies ? count_overlaps(scene, bodies, &a, &b) : 0;
    if (count > 1)
        snprintf(others, sizeof others, " (and %zu other pair%s)", count - 1, count > 2 ? "s" : "");
    if (count > 0)
        log_warning(
            "%s:%d:%d: transparent bodies \"%s\" and \"%s\" overlap%s, which the model does not cover; a "
            "body wholly inside another is no mistake, if its ior is relative to that one's (air in glass: "
            "1/1.5)",
            scene->path, b->place.line, b->place.column, a->name, b->name, others);
    free(bodies);
}

/* Whether the light shines on some point of a matte object; turned: with u and v swapped. */
static bool shines_on_any(const struct scene *scene, const struct scene_light *light, bool turned)
{
    struct dvec3 back = dvec3_unit(dvec3_cross(dvec3_of(light->quad.u), dvec3_of(light->quad.v)));
    struct dvec3 axis = dvec3_scale(turned ? 1 : -1, back);
    for (size_t i = 0; i < scene->object_count; ++i) {
        const struct body body = body_of(&scene->objects[i]);
        struct dvec3 point = body.is_ball ? body.vector : dvec3_scale(body.number, body.vector);
        double reach = body.is_ball ? body.number : 0;
        if (!body.is_ball && dvec3_length(dvec3_cross(axis, body.vector)) > RESOLUTION)
            reach = INFINITY;
        if (scene->materials[scene->objects[i].material].type == MATERIAL_MATTE &&
            dvec3_dot(axis, dvec3_subtract(point, dvec3_of(light->quad.corner))) + reach > 0)
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
