/* Ways from surface points to light points. */
#include "generate.h"

SegmentRecord connect_points(struct dvec3 from_point, struct dvec3 to_point, int surface, bool inward)
{
    struct vec3 from = round_vector(from_point), to = round_vector(to_point), way = subtract(to, from);
    if (!(dot(way, way) > (real)NEAREST_LIGHT_SQUARED)) {
        to = (struct vec3){0.5f, -0.25f, 2};
        from = (struct vec3){-0.75f, 0.25f, 1};
        way = subtract(to, from);
    }
    real length = square_root(dot(way, way));
    return (SegmentRecord){from, to, scale(1 / length, way), length, surface, inward};
}

void generate_sphere_shadows(struct random *random, sphere_shadows_input *input)
{
    struct PackedSphere sphere = random_sphere(random);
    struct dvec3 center = widen(vector_of(sphere.center_radius)), normal = random_direction(random);
    double radius = (double)sphere.center_radius.w;
    struct dvec3 on_sphere = dvec3_along(center, radius, normal), tangent = random_tangent(random, normal);
    struct dvec3 inside = random_away(random, center, radius * random_between(random, 0, 1));
    struct dvec3 from = random_point(random), to = random_point(random);
    int surface = NO_SURFACE;
    bool inward = false;
    switch (random_below(random, 20)) {
    case 0: /* leaves it */
        from = on_sphere;
        surface = 0;
        break;
    case 1: /* leaves it inward to a light inside, or passes through */
        from = on_sphere;
        surface = 0;
        inward = true;
        if (random_bool(random))
            to = inside;
        sphere.tags.HOLDS_LIGHTS = 1;
        break;
    case 2: /* leaves it and grazes */
        from = on_sphere;
        to = dvec3_along(from, radius * random_scale(random, 1e-3, 1e3), tangent);
        surface = 0;
        inward = random_bool(random);
        break;
    case 3: /* passes as a tangent */
    case 4:
        from = dvec3_along(on_sphere, -radius * random_scale(random, 1e-3, 1e2), tangent);
        to = dvec3_along(on_sphere, radius * random_scale(random, 1e-3, 1e2), tangent);
        break;
    case 5: /* light on it */
        from = random_away(random, on_sphere, random_scale(random, 1e-3, 1));
        to = on_sphere;
        sphere.tags.HOLDS_LIGHTS = random_bool(random);
        break;
    case 6: /* light inside */
        to = inside;
        sphere.tags.HOLDS_LIGHTS = 1;
        break;
    case 7: /* point inside */
        from = inside;
        sphere.tags.HOLDS_RAYS = 1;
        sphere.tags.HOLDS_LIGHTS = random_bool(random);
        break;
    case 8: /* both inside */
        from = inside;
        to = dvec3_along(center, radius * random_between(random, 0, 1), normal);
        sphere.tags.HOLDS_RAYS = sphere.tags.HOLDS_LIGHTS = 1;
        break;
    case 9: /* light about as far as the closest approach, which is in the sphere or beside it */
        to = dvec3_along(center, radius * random_between(random, 0, 1.1), normal);
        from = dvec3_along(to, random_scale(random, 1e-2, 10), tangent);
        break;
    case 10: /* from a point on it that belongs to another surface */
        from = on_sphere;
        surface = 5;
        sphere.tags.HOLDS_RAYS = random_bool(random);
        break;
    case 11: /* ends before it */
        to = dvec3_along(center, radius * random_between(random, 1, 1.01), normal);
        from = dvec3_along(to, radius * random_scale(random, 1e-3, 10), normal);
        break;
    default: /* aimed at its neighbourhood */
        to = dvec3_along(center, radius * random_between(random, 0, 1.2), normal);
        to = dvec3_along(from, random_between(random, 0.5, 3), dvec3_subtract(to, from));
    }
    if (random->promises.never_entered) {
        sphere.tags.HOLDS_RAYS = sphere.tags.HOLDS_LIGHTS = 0;
        inward = false;
    }
    *input = (sphere_shadows_input){connect_points(from, to, surface, inward), sphere};
}

void generate_plane_shadows(struct random *random, plane_shadows_input *input)
{
    struct PackedPlane plane = random_plane(random);
    struct dvec3 normal = dvec3_unit(widen(vector_of(plane.normal_offset)));
    struct dvec3 on_plane =
        random_in_plane(random, &plane, nearest_to_origin(&plane), random_between(random, -2, 2));
    struct dvec3 from = random_point(random), to = random_point(random);
    double height = random_signed(random, 1e-9, 1e-3);
    int surface = NO_SURFACE;
    switch (random_below(random, 10)) {
    case 0: /* light on it but for rounding */
        to = on_plane;
        break;
    case 1: /* light close by */
        to = dvec3_along(on_plane, height, normal);
        break;
    case 2: /* leaves it */
        from = on_plane;
        surface = 1;
        break;
    case 3: /* from a point on it that belongs to another surface */
        from = on_plane;
        break;
    case 4: /* ends on the same side */
        from = dvec3_along(on_plane, height, normal);
        to = random_in_plane(random, &plane, from, 0.5);
        break;
    default:
        break;
    }
    *input = (plane_shadows_input){connect_points(from, to, surface, false), plane};
}
