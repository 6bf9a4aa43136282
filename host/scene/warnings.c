#include "scene/warnings.h"

#include <stdio.h>
#include <stdlib.h>

#include "scene/vector.h"

/* What float arithmetic on coordinates of size 1 cannot resolve, a few units in the last place, is taken as
 * touching, not as crossing. */
static const double resolution = 0x1p-21;

/* The pairs of bodies that overlap. In the first one, the second body stands first in the file. */
struct overlaps {
    size_t count;
    const struct scene_object *a, *b;
};

/* The cheap tests first: this is asked of many pairs. */
static bool spheres_overlap(const struct scene_object *a, const struct scene_object *b)
{
    struct dvec3 first = dvec3_of(a->sphere.center), second = dvec3_of(b->sphere.center);
    struct dvec3 between = dvec3_subtract(first, second);
    double sum = a->sphere.radius + b->sphere.radius, difference = fabs(a->sphere.radius - b->sphere.radius);
    if (fabs(between.y) > sum || fabs(between.z) > sum)
        return false;
    double apart = dvec3_length(between);
    double touching = resolution * (dvec3_length(first) + dvec3_length(second) + sum);
    bool coincide = apart <= touching && difference <= touching;
    return coincide || (apart < sum - touching && apart > difference + touching);
}

static bool sphere_and_plane_overlap(const struct scene_object *sphere, const struct scene_object *plane)
{
    struct dvec3 center = dvec3_of(sphere->sphere.center), point = dvec3_of(plane->plane.point);
    double height = dvec3_dot(dvec3_unit(dvec3_of(plane->plane.normal)), dvec3_subtract(center, point));
    double touching = resolution * (dvec3_length(center) + dvec3_length(point) + sphere->sphere.radius);
    return fabs(height) < sphere->sphere.radius - touching;
}

static bool planes_overlap(const struct scene_object *a, const struct scene_object *b)
{
    struct dvec3 first = dvec3_of(a->plane.point), second = dvec3_of(b->plane.point);
    struct dvec3 normal = dvec3_unit(dvec3_of(a->plane.normal)),
                 other = dvec3_unit(dvec3_of(b->plane.normal));
    if (dvec3_length(dvec3_cross(normal, other)) > resolution)
        return true;
    double touching = resolution * (dvec3_length(first) + dvec3_length(second));
    return dvec3_dot(normal, other) > 0 && fabs(dvec3_dot(normal, dvec3_subtract(first, second))) <= touching;
}

/* Whether the surfaces of two bodies cross, or coincide with both bodies on the same side. A plane's body is
 * all that lies behind it. */
static bool overlap(const struct scene_object *a, const struct scene_object *b)
{
    if (a->type == OBJECT_SPHERE && b->type == OBJECT_SPHERE)
        return spheres_overlap(a, b);
    if (a->type == OBJECT_PLANE && b->type == OBJECT_PLANE)
        return planes_overlap(a, b);
    return a->type == OBJECT_SPHERE ? sphere_and_plane_overlap(a, b) : sphere_and_plane_overlap(b, a);
}

static double leftmost(const struct scene_object *object)
{
    return object->type == OBJECT_SPHERE ? object->sphere.center[0] - object->sphere.radius : -INFINITY;
}

static double rightmost(const struct scene_object *object)
{
    return object->type == OBJECT_SPHERE ? object->sphere.center[0] + object->sphere.radius : INFINITY;
}

static int compare_leftmost(const void *a, const void *b)
{
    double first = leftmost(*(const struct scene_object *const *)a);
    double second = leftmost(*(const struct scene_object *const *)b);
    return (first > second) - (first < second);
}

static void count_overlap(struct overlaps *overlaps, const struct scene_object *a,
                          const struct scene_object *b)
{
    const struct scene_object *earlier = a < b ? a : b, *later = a < b ? b : a;
    overlaps->count++;
    if (overlaps->count == 1 || later < overlaps->b || (later == overlaps->b && earlier < overlaps->a)) {
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
    qsort(bodies, count, sizeof *bodies, compare_leftmost);
    for (size_t i = 0; i < count; ++i)
        for (size_t k = i + 1; k < count && leftmost(bodies[k]) < rightmost(bodies[i]); ++k)
            if (overlap(bodies[i], bodies[k]))
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

/* Whether the light shines on some point of the object, with u and v as they are or swapped. */
static bool shines_on(const struct scene_light *light, bool swapped, const struct scene_object *object)
{
    struct dvec3 axis = dvec3_unit(dvec3_cross(dvec3_of(light->quad.u), dvec3_of(light->quad.v)));
    axis = dvec3_scale(swapped ? 1 : -1, axis);
    if (object->type == OBJECT_SPHERE) {
        struct dvec3 center = dvec3_of(object->sphere.center);
        return dvec3_dot(axis, dvec3_subtract(center, dvec3_of(light->quad.corner))) > -object->sphere.radius;
    }
    return dvec3_length(dvec3_cross(axis, dvec3_unit(dvec3_of(object->plane.normal)))) > resolution ||
           dvec3_dot(axis, dvec3_subtract(dvec3_of(object->plane.point), dvec3_of(light->quad.corner))) > 0;
}

static bool shines_on_any(const struct scene *scene, const struct scene_light *light, bool swapped)
{
    for (size_t i = 0; i < scene->object_count; ++i)
        if (scene->materials[scene->objects[i].material].type == MATERIAL_MATTE &&
            shines_on(light, swapped, &scene->objects[i]))
            return true;
    return false;
}

static void warn_of_lights(const struct scene *scene)
{
    const struct scene_light *first = NULL;
    size_t count = 0;
    char others[64] = "";
    for (size_t i = 0; i < scene->light_count; ++i) {
        const struct scene_light *light = &scene->lights[i];
        if (light->type != LIGHT_QUAD || shines_on_any(scene, light, false) ||
            !shines_on_any(scene, light, true))
            continue;
        first = first ? first : light;
        count++;
    }
    if (!first)
        return;
    if (count > 1)
        snprintf(others, sizeof others, " (as do %zu other%s)", count - 1, count > 2 ? "s" : "");
    log_warning("%s:%d:%d: quad light shines away from every matte surface%s; swap u and v to turn it round",
                scene->path, first->place.line, first->place.column, others);
}

void scene_warn(const struct scene *scene)
{
    warn_of_overlaps(scene);
    warn_of_lights(scene);
}
