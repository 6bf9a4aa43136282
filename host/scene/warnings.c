#include "scene/warnings.h"

#include <stdio.h>

#include "base/progress.h"
#include "scene/body.h"
#include "scene/pack.h"

enum { MOST_PAIRS = 1000 }; /* that are counted: a dense cloud of n spheres has n^2 / 2 */
enum { FIRST_BLOCK = 64, MOST_IN_BLOCK = 1 << 16, LEAST_PARALLEL = 4096 }; /* bodies */

/* A transparent body that is compared with those before it. */
struct query {
    const struct scene *scene;
    const struct packed_scene *packed;
    size_t number;
    struct body body;
    size_t most, pairs; /* when to stop; so far */
    size_t first;       /* of the bodies that it overlaps */
};

static bool is_transparent(const struct scene *scene, size_t number)
{
    return scene->materials[body_find(scene, number).object->material].type == MATERIAL_TRANSPARENT;
}

/* Whether the surfaces of two bodies cross, or coincide with both bodies on the same side. */
static bool overlap(struct body a, struct body b)
{
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

/* Compares with a body of the packed scene, as the scene file has it; whether to go on. */
static bool compare(void *user, uint32_t packed_body)
{
    struct query *query = user;
    const size_t number = (size_t)body_file_order(query->packed, (int)packed_body);
    if (number < query->number && is_transparent(query->scene, number) &&
        overlap(body_numbered(query->scene, number), query->body)) {
        query->first = query->pairs == 0 || number < query->first ? number : query->first;
        ++query->pairs;
    }
    return query->pairs < query->most;
}

/* In scene units, larger than the body is by more than float takes away from it and from one that touches it.
 */
static struct box box_around(struct body body, double scale)
{
    if (!body.is_ball)
        return (struct box){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
    body.vector = dvec3_scale(scale, body.vector);
    body.number = scale * body.number + 0x1p-22 * (1 + dvec3_largest(body.vector) + scale * body.number);
    return body_box(body);
}

/* Finds up to `most` transparent bodies before this one that it overlaps. */
static struct query find_partners(const struct scene *scene, const struct packed_scene *packed, double scale,
                                  size_t number, size_t most)
{
    struct query query = {scene, packed, number, body_numbered(scene, number), .most = most};
    body_visit(packed, box_around(query.body, scale), compare, &query);
    return query;
}

static void warn_of_pair(const struct scene *scene, size_t pairs, struct body_place earlier,
                         struct body_place later)
{
    char others[64] = "", earlier_name[BODY_NAME], later_name[BODY_NAME];
    if (pairs > 1)
        snprintf(others, sizeof others, " (and %s%zu other pair%s)", pairs >= MOST_PAIRS ? "at least " : "",
                 pairs >= MOST_PAIRS ? MOST_PAIRS - 1 : pairs - 1, pairs > 2 ? "s" : "");
    log_warning("%s:%d:%d: transparent bodies %s and %s overlap%s, which the model does not cover; a body "
                "wholly inside another is no mistake, if its ior is relative to that one's (air in glass: "
                "1/1.5)",
                scene->path, later.object->place.line, later.object->place.column,
                body_name(earlier, earlier_name), body_name(later, later_name), others);
}

/* Of the pair that is complete first in the file, of its partners the first, and of how many pairs more there
 * are. They are looked for block after block, so that the first one is known when there are enough. */
static void warn_of_overlaps(const struct scene *scene, const struct packed_scene *packed)
{
    const double scale = pack_scale(scene);
    size_t pairs = 0, later = SIZE_MAX;
    struct progress progress;
    progress_start(&progress, "looking for overlaps", scene->body_count, false);
    for (size_t first = 0, size = FIRST_BLOCK, end; first < scene->body_count && pairs < MOST_PAIRS;
         first = end, size = size < MOST_IN_BLOCK ? 2 * size : size) {
        end = scene->body_count - first < size ? scene->body_count : first + size;
#pragma omp parallel for reduction(+ : pairs) reduction(min : later) schedule(dynamic, 16)                           \
    if (scene->body_count > LEAST_PARALLEL)
        for (size_t i = first; i < end; ++i) {
            size_t found =
                is_transparent(scene, i) ? find_partners(scene, packed, scale, i, MOST_PAIRS).pairs : 0;
            pairs += found;
            later = found > 0 && i < later ? i : later;
        }
        progress_advance(&progress, end - first);
    }
    progress_end(&progress);
    if (pairs > 0)
        warn_of_pair(scene, pairs,
                     body_find(scene, find_partners(scene, packed, scale, later, SIZE_MAX).first),
                     body_find(scene, later));
}

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

void scene_warn(const struct scene *scene, const struct packed_scene *packed)
{
    warn_of_overlaps(scene, packed);
    warn_of_lights(scene);
}
