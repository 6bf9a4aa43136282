#include "hostile_spheres.h"

#include <assert.h>

/* To what this build computes with, from values that a scene or a ray of it may have. */
static struct vec3 to_real(struct dvec3 v)
{
#if REFERENCE_BITS == 32
    return round_vector(v);
#else
    return (struct vec3){v.x, v.y, v.z};
#endif
}

static struct dvec3 center_of(const struct PackedSphere *sphere)
{
    layout_vec4 shape = sphere->center_radius;
    return (struct dvec3){(double)shape.x, (double)shape.y, (double)shape.z};
}

static struct dvec3 random_near(struct random *random, struct dvec3 place, double size)
{
    return dvec3_along(place, size, random_point(random));
}

/* The centre of the next sphere, of such a radius, and of none before it if `first`. */
static struct dvec3 place_center(struct random *random, unsigned pattern, double size,
                                 const struct PackedSphere *before, bool first, double *radius)
{
    static const struct dvec3 along = {0.6, 0, 0.8};
    const struct dvec3 last = first ? (struct dvec3){0, 0, 0} : center_of(before);
    struct dvec3 center;
    switch (first ? 0 : pattern) {
    case 1: /* in one plane */
        center = random_near(random, last, size);
        center.y = last.y;
        return center;
    case 2: /* on one line */
        return dvec3_along(last, random_between(random, -size, size), along);
    case 3: /* around one point */
        return last;
    case 4: /* the same */
        *radius = (double)before->center_radius.w;
        return last;
    case 5: /* touching the one before */
        return random_away(random, last, *radius + (double)before->center_radius.w);
    case 6: /* on a grid, equally large */
        *radius = (double)before->center_radius.w;
        return dvec3_along(last, 2 * *radius, random_axis(random));
    case 7: /* within or around the one before, nearly touching it */
        return random_away(random, last, fabs(*radius - (double)before->center_radius.w));
    default:
        return random_near(random, (struct dvec3){0, 0, 0}, size);
    }
}

/* The others stand in order, each looped one before some of them. */
static void choose_file_order(struct random *random, struct hostile_scene *scene, unsigned looped,
                              unsigned count)
{
    enum { PLACES_BETWEEN = 16 };
    for (unsigned i = looped; i < count; ++i)
        scene->spheres[i].tags.FILE_ORDER = (int)(i * PLACES_BETWEEN);
    for (unsigned i = 0; i < looped; ++i) {
        const unsigned behind = random_below(random, count);
        scene->spheres[i].tags.FILE_ORDER = (int)(behind * PLACES_BETWEEN + i + 1);
        scene->surfaces[i].tags.OTHERS_BEFORE = behind < looped ? 0 : (int)(behind - looped + 1);
    }
}

void hostile_scene_create(struct random *random, unsigned count, struct hostile_scene *scene)
{
    const unsigned most = one_in(random, 4) ? 1 : one_in(random, 16) ? MOST_HOSTILE_SPHERES : 12;
    if (count == 0)
        count = 1 + random_below(random, most);
    const unsigned pattern = random_below(random, 9);
    const double size = one_in(random, 3) ? 1 : random_scale(random, 1e-8, 1);
    const bool alike = random_bool(random);
    const double shared_radius = random_scale(random, 1e-10, 0.5);
    *scene = (struct hostile_scene){.unit = real_unit};
    for (unsigned i = 0; i < count; ++i) {
        struct PackedSphere *sphere = &scene->spheres[i];
        double radius = alike ? shared_radius : random_scale(random, 1e-10, 0.5);
        struct dvec3 center = place_center(random, pattern, size, sphere - (i > 0), i == 0, &radius);
        struct vec3 rounded = round_vector(center);
        sphere->center_radius =
            (layout_vec4){(float)rounded.x, (float)rounded.y, (float)rounded.z, round_number(radius)};
        sphere->tags.HOLDS_RAYS = random_bool(random);
        sphere->tags.HOLDS_LIGHTS = random_bool(random);
    }
    int looped = one_in(random, 4)
                     ? (int)random_below(random, count < MOST_HOSTILE_LOOPED ? count : MOST_HOSTILE_LOOPED)
                     : 0;
    choose_file_order(random, scene, (unsigned)looped, count);
    scene->without = (struct packed_scene){
        .sphere_count = (int)count,
        .looped_spheres = looped,
        .spheres = scene->spheres,
        .surfaces = scene->surfaces,
    };
    scene->with_tree = scene->without;
    scene->with_tree.tree = scene->tree =
        sphere_tree_create(scene->spheres, looped, (int)count, 1, NULL, NULL);
    assert(scene->tree);
}

void hostile_scene_destroy(struct hostile_scene *scene)
{
    sphere_tree_destroy(&scene->tree);
}

void hostile_scene_blur(struct random *random, struct hostile_scene *scene)
{
    scene->e_origin = one_in(random, 3) ? 0 : random_scale(random, 1e-12, 1e-2);
    scene->e_direction = one_in(random, 3) ? 0 : random_scale(random, 1e-8, 0.5);
    scene->unit = 0x1p-24;
}

/* A few times what a ray loses on a way, to either side. */
static double some_error(struct random *random, const struct hostile_scene *scene, double way)
{
    return random_between(random, -3, 3) * (scene->e_origin + way * (scene->e_direction + scene->unit));
}

/* So far from a sphere's centre that errors decide whether it is passed. */
static double grazing_distance(struct random *random, const struct hostile_scene *scene, double radius,
                               double way)
{
    return radius + some_error(random, scene, way + radius);
}

/* How far before the sphere a ray may begin. */
static double random_way(struct random *random, double radius)
{
    return one_in(random, 16) ? random_scale(random, 1, FARTHEST_HIT)
                              : random_scale(random, radius * 1e-2, 4);
}

struct ray hostile_ray(struct random *random, const struct hostile_scene *scene)
{
    const int aim = (int)random_below(random, (unsigned)scene->without.sphere_count);
    const struct PackedSphere *sphere = &scene->spheres[aim];
    const struct dvec3 center = center_of(sphere);
    const double radius = (double)sphere->center_radius.w;
    const struct dvec3 normal = random_direction(random), tangent = random_tangent(random, normal);
    const double way = random_way(random, radius);
    struct dvec3 direction = one_in(random, 4) ? random_axis(random) : random_direction(random);
    struct dvec3 origin = dvec3_along(center, -way, direction); /* at the centre */
    struct ray ray = {.surface = NO_SURFACE};
    switch (random_below(random, 10)) {
    case 0: /* leaves it */
        origin = dvec3_along(center, radius, normal);
        ray.surface = aim;
        break;
    case 1: /* leaves it and grazes */
        origin = dvec3_along(center, radius, normal);
        direction = dvec3_unit(dvec3_along(tangent, random_signed(random, 1e-9, 1e-2), normal));
        ray.surface = aim;
        break;
    case 2: /* begins within it, sometimes near its surface or centre */
        origin = dvec3_along(center, radius * (1 - random_scale(random, 1e-8, 1)), normal);
        break;
    case 3: /* begins on it, knowing nothing of it */
        origin = dvec3_along(center, grazing_distance(random, scene, radius, 0), normal);
        break;
    case 4: /* somewhere */
        origin = random_point(random);
        break;
    case 5: /* at it */
    case 6:
        break;
    default: /* grazes */
        origin = random_aside(random, direction, origin, grazing_distance(random, scene, radius, way));
    }
    ray.origin = to_real(origin);
    ray.direction = to_real(direction);
    ray.inward = ray.surface == aim && dvec3_dot(direction, normal) < 0;
    return ray;
}

struct segment hostile_segment(struct random *random, const struct hostile_scene *scene)
{
    const struct ray ray = hostile_ray(random, scene);
    const int aim = (int)random_below(random, (unsigned)scene->without.sphere_count);
    const struct PackedSphere *sphere = &scene->spheres[aim];
    const struct dvec3 center = center_of(sphere), direction = widen(ray.direction);
    const double radius = (double)sphere->center_radius.w;
    const struct dvec3 from = widen(ray.origin);
    const double along = dvec3_dot(dvec3_subtract(center, from), direction);
    struct dvec3 to = random_near(random, center, 2 * radius);
    switch (random_below(random, 5)) {
    case 0: /* beside its middle */
        to = dvec3_along(from, along + some_error(random, scene, fabs(along) + radius), direction);
        break;
    case 1: /* on its surface */
        to = random_away(random, center, grazing_distance(random, scene, radius, 0));
        break;
    case 2: /* beyond */
        to = dvec3_along(from, fabs(along) + random_scale(random, radius, 8), direction);
        break;
    default:
        break;
    }
    if (dvec3_distance(to, from) < 0x1p-29) /* no light shines from there */
        to = dvec3_along(to, 1, random_axis(random));
    struct segment segment = {
        .from = ray.origin, .to = to_real(to), .surface = ray.surface, .inward = ray.inward};
    struct vec3 way = subtract(segment.to, segment.from);
    segment.length = square_root(dot(way, way));
    segment.direction = scale(1 / segment.length, way);
    return segment;
}
