/* Rays and segments at giants, most of them near the origin of coordinates. */
#include "generate.h"

/* Of a giant: its numbers are floats, computed with in double. */
struct drawn {
    struct dvec3 gradient;
    double offset, curvature;
};

static struct drawn random_giant(struct random *random, struct PackedSphere *giant, float *curvature)
{
    const double radius = random_scale(random, one_in(random, 8) ? 1e-2 : 8, 0x1p32);
    const double height = one_in(random, 8) ? 0 : random_between(random, -1, 1);
    struct dvec3 normal = one_in(random, 4) ? random_axis(random) : random_direction(random);
    struct vec3 gradient = round_vector(dvec3_scale(1 - height / radius, normal));
    const float offset = round_number(height * (1 - height / (2 * radius)));
    *giant = (struct PackedSphere){.center_radius = {gradient.x, gradient.y, gradient.z, offset}};
    *curvature = (float)(1 / radius);
    return (struct drawn){widen(gradient), (double)offset, (double)*curvature};
}

static struct dvec3 gradient_at(const struct drawn *giant, struct dvec3 point)
{
    return dvec3_along(giant->gradient, giant->curvature, point);
}

/* The point, moved to the height. */
static struct dvec3 at_height(const struct drawn *giant, struct dvec3 point, double height)
{
    for (int i = 0; i < 4; ++i) {
        struct dvec3 gradient = gradient_at(giant, point);
        double off = dvec3_dot(dvec3_along(giant->gradient, giant->curvature / 2, point), point) -
                     giant->offset - height;
        point = dvec3_along(point, -off / dvec3_dot(gradient, gradient), gradient);
    }
    return point;
}

void generate_meet_giant(struct random *random, meet_giant_input *input)
{
    const struct drawn giant = random_giant(random, &input->giant, &input->curvature);
    const double far_out = one_in(random, 8) ? random_scale(random, 1, 1e3) : 1;
    struct dvec3 place = dvec3_scale(far_out, random_point(random));
    struct dvec3 on = at_height(&giant, place, 0), normal = dvec3_unit(gradient_at(&giant, on));
    struct dvec3 tangent = random_tangent(random, normal);
    struct dvec3 origin = random_point(random), direction = random_direction(random);
    RayRecord ray = {.surface = NO_SURFACE};
    switch (random_below(random, 16)) {
    case 0: /* leaves it */
    case 1:
        origin = on;
        ray.surface = 0;
        break;
    case 2: /* leaves it and grazes */
        origin = on;
        direction = dvec3_unit(dvec3_along(tangent, random_signed(random, 1e-12, 1e-2), normal));
        ray.surface = 0;
        break;
    case 3: /* tangent but for rounding, from about where the horizon is seen */
    case 4:
        direction = tangent;
        origin = dvec3_along(on, -random_scale(random, 1e-3, 1e3), tangent);
        break;
    case 5: /* about as flat as the smallest slope that counts */
        origin = on;
        direction = dvec3_along(tangent, random_signed(random, 0x1p-52, 0x1p-48), normal);
        break;
    case 6: /* from close by, on either side */
        origin = dvec3_along(on, random_signed(random, 1e-12, 1e-3), normal);
        input->giant.tags.HOLDS_RAYS = random_bool(random);
        break;
    case 7: /* from inside */
    case 8:
        origin = at_height(&giant, place, -random_scale(random, 1e-6, 1));
        input->giant.tags.HOLDS_RAYS = 1;
        break;
    case 9: /* from inside, along the surface or straight down */
        origin = at_height(&giant, place, -random_scale(random, 1e-6, 1));
        direction = random_bool(random) ? tangent : dvec3_scale(random_sign(random), normal);
        input->giant.tags.HOLDS_RAYS = 1;
        break;
    case 10: /* from a point on it that belongs to another surface */
        origin = on;
        ray.surface = 7;
        input->giant.tags.HOLDS_RAYS = random_bool(random);
        break;
    case 11: /* straight down or up */
        origin = dvec3_along(on, random_scale(random, 1e-3, 1e3), normal);
        direction = dvec3_scale(random_sign(random), normal);
        break;
    case 12: /* from far away */
        origin = random_away(random, on, random_scale(random, 1e2, 1e6));
        direction = dvec3_unit(dvec3_subtract(on, origin));
        break;
    default: /* aimed at it */
        origin = at_height(&giant, origin, random_scale(random, 1e-3, 2));
        direction = dvec3_unit(dvec3_subtract(on, origin));
    }
    ray.inward = ray.surface == 0 && dvec3_dot(direction, normal) < 0;
    if (random->promises.never_entered) {
        input->giant.tags.HOLDS_RAYS = 0;
        ray.inward = false;
    }
    ray.origin = round_vector(origin);
    ray.direction = round_vector(direction);
    input->ray = ray;
}

void generate_giant_shadows(struct random *random, giant_shadows_input *input)
{
    const struct drawn giant = random_giant(random, &input->giant, &input->curvature);
    struct dvec3 on = at_height(&giant, random_point(random), 0),
                 normal = dvec3_unit(gradient_at(&giant, on));
    struct dvec3 tangent = random_tangent(random, normal);
    struct dvec3 from = random_point(random), to = random_point(random);
    layout_ivec4 *tags = &input->giant.tags;
    int surface = NO_SURFACE;
    bool inward = false;
    switch (random_below(random, 12)) {
    case 0: /* leaves it */
        from = on;
        surface = 0;
        inward = random_bool(random);
        tags->HOLDS_LIGHTS = random_bool(random);
        break;
    case 1: /* passes as a tangent */
    case 2:
        from = dvec3_along(on, -random_scale(random, 1e-3, 1e3), tangent);
        to = dvec3_along(on, random_scale(random, 1e-3, 1e3), tangent);
        break;
    case 3: /* light on it, or close by */
        from = at_height(&giant, from, random_scale(random, 1e-3, 2));
        to = dvec3_along(on, random_bool(random) ? 0 : random_signed(random, 1e-9, 1e-3), normal);
        tags->HOLDS_LIGHTS = random_bool(random);
        break;
    case 4: /* both outside, close to it, with its back in between */
        from = dvec3_along(on, random_scale(random, 1e-7, 1e-1), normal);
        to = at_height(&giant, dvec3_along(on, random_scale(random, 1, 1e4), tangent),
                       random_scale(random, 1e-7, 1e-1));
        break;
    case 5: /* point inside, light inside or not */
        from = at_height(&giant, from, -random_scale(random, 1e-6, 1));
        tags->HOLDS_RAYS = 1;
        tags->HOLDS_LIGHTS = random_bool(random);
        if (random_bool(random))
            to = at_height(&giant, to, -random_scale(random, 1e-6, 1));
        break;
    case 6: /* light inside */
        to = at_height(&giant, to, -random_scale(random, 1e-6, 1));
        tags->HOLDS_LIGHTS = 1;
        break;
    case 7: /* from a point on it that belongs to another surface */
        from = on;
        surface = 5;
        tags->HOLDS_RAYS = random_bool(random);
        break;
    default: /* down or up */
        from = at_height(&giant, from, random_scale(random, 1e-3, 2));
        to = at_height(&giant, to, random_scale(random, 1e-3, 2));
    }
    if (random->promises.never_entered) {
        tags->HOLDS_RAYS = tags->HOLDS_LIGHTS = 0;
        inward = false;
    }
    input->segment = connect_points(from, to, surface, inward);
}
