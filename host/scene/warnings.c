#include "scene/warnings.h"

#include <stdio.h>
#include <stdlib.h>

#include "scene/vector.h"

/* What float arithmetic on coordinates of size 1 cannot resolve, a few units in the last place, is taken as
 * touching, not as crossing. */
static const double resolution = 0x1p-21;

/* Signed: positive outside a sphere and on the side of a plane's normal. */
static double distance_from(const struct scene_object *surface, struct dvec3 point)
{
    if (surface->type == OBJECT_SPHERE)
        return dvec3_distance(point, dvec3_of(surface->sphere.center)) - surface->sphere.radius;
    return dvec3_dot(dvec3_unit(dvec3_of(surface->plane.normal)),
                     dvec3_subtract(point, dvec3_of(surface->plane.point)));
}

static bool planes_overlap(const struct scene_object *a, const struct scene_object *b)
{
    struct dvec3 normal = dvec3_unit(dvec3_of(a->plane.normal)),
                 other = dvec3_unit(dvec3_of(b->plane.normal));
    struct dvec3 point = dvec3_of(b->plane.point);
    return dvec3_length(dvec3_cross(normal, other)) > resolution ||
           (dvec3_dot(normal, other) > 0 &&
            fabs(distance_from(a, point)) <= resolution * dvec3_length(point));
}

/* Whether the surface of a ball crosses the other surface, that of a larger ball or of a plane. */
static bool ball_overlaps(const struct scene_object *ball, const struct scene_object *other)
{
    struct dvec3 center = dvec3_of(ball->sphere.center);
    double radius = ball->sphere.radius, touching = resolution * (dvec3_length(center) + radius);
    double distance = distance_from(other, center);
    bool coincide = other->type == OBJECT_SPHERE && other->sphere.radius - radius <= touching &&
                    fabs(distance + radius) <= touching;
    return coincide || fabs(distance) < radius - touching;
}

/* Whether the surfaces of two bodies cross, or coincide with both bodies on the same side. What lies behind a
 * plane is its body. */
static bool overlap(const struct scene_object *a, const struct scene_object *b)
{
    if (a->type == OBJECT_PLANE && b->type == OBJECT_PLANE)
        return planes_overlap(a, b);
    bool a_is_ball =
        b->type == OBJECT_PLANE || (a->type == OBJECT_SPHERE && a->sphere.radius <= b->sphere.radius);
    return a_is_ball ? ball_overlaps(a, b) : ball_overlaps(b, a);
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
            dvec3_length(dvec3_cross(axis, dvec3_unit(dvec3_of(object->plane.normal)))) > resolution)
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
