/* Rays that leave a surface, as pbrt-v4's Reintersect tests them: from spheres of radii over eight decades
 * and from planes, outward they never meet it again, and inward they always end on the sphere's far side. */
#include "../cmocka_test.h"

#include "geometry.h"
#include "random.h"

#ifndef CASES
#define CASES 1000000
#endif

static const double half_ulp = 0x1p-24; /* of 1: the relative error of one operation */

/* How far a point may be off its surface, in roundings of the largest coordinate that went into it. On a
 * sphere that is center + radius normal: the normal's length is off by at most 4.5 half ulps (a square root,
 * a division, a product and half of what the dot product has), the product by one, the sum by one. */
static const double sphere_point_operations = 7.5;

/* The chord 2 (o - c) . d, in roundings of the radius: a difference, a product and two sums. */
static const double chord_operations = 8;

/* After one correction by the distance to the plane: that distance is a dot product of three roundings. */
static const double plane_point_operations = 3;

static double size_of(struct vec3 v)
{
    return dvec3_length(widen(v));
}

/* Of a point at the sphere, in units of half_ulp of its radius and its centre's distance. */
static double off_sphere(const struct PackedSphere *sphere, struct vec3 point)
{
    struct vec3 center = vector_of(sphere->center_radius);
    double radius = (double)sphere->center_radius.w;
    double off = dvec3_length(dvec3_subtract(widen(point), widen(center))) - radius;
    return fabs(off) / (half_ulp * (radius + size_of(center)));
}

static struct ray leave(const struct hit *hit, struct random *random, bool inward, struct vec3 outward_normal)
{
    struct dvec3 direction = random_direction(random), normal = widen(outward_normal);
    if (random_below(random, 4) == 0) { /* grazes */
        struct dvec3 tangent = random_tangent(random, dvec3_unit(normal));
        direction = dvec3_unit(dvec3_along(tangent, random_scale(random, 1e-7, 1e-2), normal));
    }
    if ((dvec3_dot(direction, normal) < 0) != inward)
        direction = dvec3_scale(-1, direction);
    return (struct ray){hit->point, round_vector(direction), hit->surface, inward};
}

static void assert_not_shadowed(const struct packed_scene *scene, const struct ray *ray)
{
    real length = 1;
    struct segment segment = {ray->origin,    add(ray->origin, scale(length, ray->direction)),
                              ray->direction, length,
                              ray->surface,   ray->inward};
    assert_false(is_blocked(scene, &segment));
}

struct sphere_errors {
    double point, distance; /* in half_ulp of radius and centre's distance */
    long inward;
};

/* From one hit, whichever side was met. */
static void leave_sphere(const struct packed_scene *scene, struct hit hit, struct random *random,
                         struct sphere_errors *errors)
{
    const struct PackedSphere *sphere = scene->spheres;
    struct vec3 center = vector_of(sphere->center_radius);
    for (int bounce = 0; bounce < 4; ++bounce) {
        errors->point = fmax(errors->point, off_sphere(sphere, hit.point));
        struct vec3 outward_normal = hit.from_inside ? negate(hit.normal) : hit.normal;
        struct ray outward = leave(&hit, random, false, outward_normal);
        struct hit next;
        assert_false(find_hit(scene, &outward, &next));
        assert_not_shadowed(scene, &outward);

        struct ray inward = leave(&hit, random, true, outward_normal);
        assert_true(find_hit(scene, &inward, &next));
        assert_true(next.from_inside && next.distance >= 0 && next.surface == 0);
        struct dvec3 to_center = dvec3_subtract(widen(center), widen(inward.origin));
        double chord = fmax(0, 2 * dvec3_dot(to_center, widen(inward.direction)));
        errors->distance = fmax(errors->distance, fabs((double)next.distance - chord) /
                                                      (half_ulp * (double)sphere->center_radius.w));
        ++errors->inward;
        hit = next;
    }
}

static void test_spheres(void **state)
{
    (void)state;
    struct sphere_errors errors = {0};
    long met = 0;
    for (uint64_t i = 0; met < CASES / 4; ++i) { /* four rays outward and four inward from each */
        struct random random = random_start(1, 0, i);
        struct vec3 center = round_vector(random_point(&random));
        double radius = random_scale(&random, 1e-4, 1e4);
        struct PackedSphere sphere = {.center_radius = {center.x, center.y, center.z, (float)radius}};
        struct dvec3 aim = random_away(&random, widen(center), radius * random_between(&random, 0, 1));
        struct dvec3 origin = random_away(&random, widen(center), radius * random_scale(&random, 1.001, 1e3));
        if (random_below(&random, 8) == 0) { /* the camera is inside */
            origin = random_away(&random, widen(center), radius * random_between(&random, 0, 0.999));
            sphere.tags.HOLDS_RAYS = 1;
        }
        struct ray ray = {.origin = round_vector(origin),
                          .direction = round_vector(dvec3_unit(dvec3_subtract(aim, origin))),
                          .surface = NO_SURFACE};
        PackedSurface surface = {.tags = {0}};
        const struct packed_scene scene = {
            .sphere_count = 1, .looped_spheres = 1, .spheres = &sphere, .surfaces = &surface};
        struct hit hit;
        if (!find_hit(&scene, &ray, &hit))
            continue;
        ++met;
        leave_sphere(&scene, hit, &random, &errors);
    }
    print_message(
        "%ld rays outward, %ld inward: points within %.2f half ulps of |center| + radius, distances "
        "within %.2f of the radius\n",
        4 * met, errors.inward, errors.point, errors.distance);
    assert_true(errors.point <= sphere_point_operations);
    assert_true(errors.distance <= chord_operations);
}

/* Of a point of a giant, which has been moved by its height: a product, a sum and a dot product, five
 * roundings; minus the offset; moved. */
static const double giant_point_operations = 7;

/* In units of half_ulp of 1 + |point|, that times the gradient's length at most. */
static double off_giant(const struct packed_scene *scene, struct vec3 point)
{
    const struct giant giant = giant_of(scene, 0);
    const struct dvec3 gradient = widen(giant.gradient), place = widen(point);
    const double curvature = (double)giant.curvature, size = dvec3_length(place);
    double height = dvec3_dot(dvec3_along(gradient, curvature / 2, place), place) - (double)giant.offset;
    return fabs(height) / (half_ulp * (1 + size * (1 + curvature * size)));
}

static void test_giants(void **state)
{
    (void)state;
    double worst = 0;
    long met = 0;
    for (uint64_t i = 0; met < CASES / 4; ++i) {
        struct random random = random_start(3, 0, i);
        const double radius = random_scale(&random, 16, 0x1p32), height = random_between(&random, -1, 1);
        const struct dvec3 normal = random_direction(&random);
        const struct vec3 gradient = round_vector(dvec3_scale(1 - height / radius, normal));
        const bool inside = random_below(&random, 4) == 0;
        struct PackedSphere sphere = {.center_radius = {gradient.x, gradient.y, gradient.z,
                                                        (float)(height * (1 - height / (2 * radius)))},
                                      .tags.HOLDS_RAYS = inside};
        PackedSurface surface = {.more_parameters.CURVATURE = (float)(1 / radius)};
        const struct packed_scene scene = {
            .sphere_count = 1, .looped_spheres = 1, .giants = 1, .spheres = &sphere, .surfaces = &surface};
        const double from = (inside ? -1 : 1) * random_scale(&random, 1e-6, 1);
        struct ray ray = {.origin = round_vector(dvec3_scale(height + from, normal)), .surface = NO_SURFACE};
        ray.direction = round_vector(random_direction(&random));
        struct hit hit, next;
        if (!find_hit(&scene, &ray, &hit))
            continue;
        assert_true(hit.from_inside == inside);
        ++met;
        for (int bounce = 0; bounce < 3; ++bounce) {
            worst = fmax(worst, off_giant(&scene, hit.point));
            struct vec3 outward_normal = hit.from_inside ? negate(hit.normal) : hit.normal;
            struct ray outward = leave(&hit, &random, false, outward_normal);
            assert_false(find_hit(&scene, &outward, &next));
            assert_not_shadowed(&scene, &outward);
            struct ray inward = leave(&hit, &random, true, outward_normal);
            assert_true(find_hit(&scene, &inward, &next));
            assert_true(next.from_inside && next.distance >= 0);
            hit = next;
        }
    }
    print_message("%ld hits of giants: points within %.2f half ulps of 1 + |point|\n", met, worst);
    assert_true(worst <= giant_point_operations);
}

static void test_planes(void **state)
{
    (void)state;
    double worst = 0;
    long met = 0;
    for (uint64_t i = 0; met < CASES; ++i) {
        struct random random = random_start(2, 0, i);
        struct vec3 normal =
            round_vector(random_bool(&random) ? random_axis(&random) : random_direction(&random));
        struct PackedPlane plane = {
            .normal_offset = {normal.x, normal.y, normal.z, (float)random_between(&random, -1, 1)}};
        bool transparent = random_bool(&random);
        plane.surface.tags.SURFACE_KIND = transparent ? KIND_TRANSPARENT : KIND_MIRROR;
        plane.surface.tags.CASTS_SHADOWS = 1;
        struct ray ray = {.origin = round_vector(random_point(&random)), .surface = NO_SURFACE};
        ray.direction = round_vector(random_direction(&random));
        const struct packed_scene scene = {.plane_count = 1, .planes = &plane};
        struct hit hit, next;
        if ((!transparent && dot(normal, ray.origin) < plane.normal_offset.w) ||
            !find_hit(&scene, &ray, &hit))
            continue;
        ++met;
        double off = dvec3_dot(widen(normal), widen(hit.point)) - (double)plane.normal_offset.w;
        worst = fmax(worst, fabs(off) / (half_ulp * (1 + size_of(hit.point))));
        for (int side = 0; side < (transparent ? 2 : 1); ++side) {
            struct ray departing = leave(&hit, &random, side == 1, hit.normal);
            assert_false(find_hit(&scene, &departing, &next));
            if (transparent)
                assert_not_shadowed(&scene, &departing);
        }
    }
    print_message("%ld hits: points within %.2f half ulps of 1 + |point|\n", met, worst);
    assert_true(worst <= plane_point_operations);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_spheres), cmocka_unit_test(test_giants),
                                       cmocka_unit_test(test_planes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
