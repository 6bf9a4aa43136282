/* Ways from surface points to light points. */
#include "generate.h"

static void put_segment(struct word_writer *inputs, const struct segment *segment)
{
    put_vector(inputs, "from", segment->from);
    put_vector(inputs, "to", segment->to);
    put_vector(inputs, "direction", segment->direction);
    put_real(inputs, "length", segment->length);
    put_integer(inputs, "surface", (uint32_t)segment->surface);
    put_integer(inputs, "inward", segment->inward);
}

/* As the renderer does it; a light as near as this does not shine. */
static void connect(struct segment *segment)
{
    struct vec3 way = subtract(segment->to, segment->from);
    if (!(dot(way, way) > (real)NEAREST_LIGHT_SQUARED)) {
        segment->to = (struct vec3){0.5f, -0.25f, 2};
        segment->from = (struct vec3){-0.75f, 0.25f, 1};
        way = subtract(segment->to, segment->from);
    }
    segment->length = square_root(dot(way, way));
    segment->direction = scale(1 / segment->length, way);
}

void generate_sphere_segment(struct random *random, const struct promises *promises,
                             struct word_writer *inputs)
{
    struct PackedSphere sphere = random_sphere(random);
    struct dvec3 center = widen(vector_of(sphere.center_radius)), normal = random_direction(random);
    double radius = (double)sphere.center_radius.w;
    struct dvec3 on_sphere = dvec3_along(center, radius, normal), tangent = random_tangent(random, normal);
    struct dvec3 inside = random_away(random, center, radius * random_between(random, 0, 1));
    struct dvec3 from = random_point(random), to = random_point(random);
    struct segment segment = {.surface = NO_SURFACE};
    switch (random_below(random, 20)) {
    case 0: /* leaves it */
        from = on_sphere;
        segment.surface = 0;
        break;
    case 1: /* leaves it inward to a light inside, or passes through */
        from = on_sphere;
        segment.surface = 0;
        segment.inward = true;
        if (random_bool(random))
            to = inside;
        sphere.surface.tags.HOLDS_LIGHTS = 1;
        break;
    case 2: /* leaves it and grazes */
        from = on_sphere;
        to = dvec3_along(from, radius * random_scale(random, 1e-3, 1e3), tangent);
        segment.surface = 0;
        segment.inward = random_bool(random);
        break;
    case 3: /* passes as a tangent */
    case 4:
        from = dvec3_along(on_sphere, -radius * random_scale(random, 1e-3, 1e2), tangent);
        to = dvec3_along(on_sphere, radius * random_scale(random, 1e-3, 1e2), tangent);
        break;
    case 5: /* light on it */
        from = random_away(random, on_sphere, random_scale(random, 1e-3, 1));
        to = on_sphere;
        sphere.surface.tags.HOLDS_LIGHTS = random_bool(random);
        break;
    case 6: /* light inside */
        to = inside;
        sphere.surface.tags.HOLDS_LIGHTS = 1;
        break;
    case 7: /* point inside */
        from = inside;
        sphere.surface.tags.HOLDS_RAYS = 1;
        sphere.surface.tags.HOLDS_LIGHTS = random_bool(random);
        break;
    case 8: /* both inside */
        from = inside;
        to = dvec3_along(center, radius * random_between(random, 0, 1), normal);
        sphere.surface.tags.HOLDS_RAYS = sphere.surface.tags.HOLDS_LIGHTS = 1;
        break;
    case 9: /* light about as far as the closest approach, which is in the sphere or beside it */
        to = dvec3_along(center, radius * random_between(random, 0, 1.1), normal);
        from = dvec3_along(to, random_scale(random, 1e-2, 10), tangent);
        break;
    case 10: /* from a point on it that belongs to another surface */
        from = on_sphere;
        segment.surface = 5;
        sphere.surface.tags.HOLDS_RAYS = random_bool(random);
        break;
    case 11: /* ends before it */
        to = dvec3_along(center, radius * random_between(random, 1, 1.01), normal);
        from = dvec3_along(to, radius * random_scale(random, 1e-3, 10), normal);
        break;
    default: /* aimed at its neighbourhood */
        to = dvec3_along(center, radius * random_between(random, 0, 1.2), normal);
        to = dvec3_along(from, random_between(random, 0.5, 3), dvec3_subtract(to, from));
    }
    if (promises->never_entered) {
        sphere.surface.tags.HOLDS_RAYS = sphere.surface.tags.HOLDS_LIGHTS = 0;
        segment.inward = false;
    }
    segment.from = round_vector(from);
    segment.to = round_vector(to);
    connect(&segment);
    put_segment(inputs, &segment);
    put_sphere(inputs, &sphere);
}

void generate_plane_segment(struct random *random, const struct promises *promises,
                            struct word_writer *inputs)
{
    struct PackedPlane plane = random_plane(random, promises);
    struct dvec3 normal = dvec3_unit(widen(vector_of(plane.normal_offset)));
    struct dvec3 on_plane = dvec3_scale((double)plane.normal_offset.w, normal);
    on_plane = random_in_plane(random, &plane, on_plane, random_between(random, -2, 2));
    struct dvec3 from = random_point(random), to = random_point(random);
    double height = random_signed(random, 1e-9, 1e-3);
    struct segment segment = {.surface = NO_SURFACE};
    switch (random_below(random, 10)) {
    case 0: /* light on it but for rounding */
        to = on_plane;
        break;
    case 1: /* light close by */
        to = dvec3_along(on_plane, height, normal);
        break;
    case 2: /* leaves it */
        from = on_plane;
        segment.surface = 1;
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
    segment.from = round_vector(from);
    segment.to = round_vector(to);
    connect(&segment);
    put_segment(inputs, &segment);
    put_plane(inputs, &plane);
}
