/* Rays and segments at spheres and giants. */
#include "generate.h"

/* A sphere or a giant: its numbers are floats, computed with in double. */
struct drawn {
    bool is_giant;
    struct dvec3 vector;              /* centre, or gradient */
    double number, curvature;         /* radius; or offset, and a giant's curvature */
    double size;                      /* of what is near it: the radius, or 1 */
    struct dvec3 on, normal, tangent; /* a point of the surface */
};

struct PackedSphere random_sphere(struct random *random)
{
    struct vec3 center = round_vector(random_point(random));
    float radius =
        round_number(random_bool(random) ? random_scale(random, 1e-4, 1e4) : random_scale(random, 0.02, 0.5));
    return (struct PackedSphere){.center_radius = {center.x, center.y, center.z, radius}};
}

static struct dvec3 gradient_at(const struct drawn *giant, struct dvec3 point)
{
    return dvec3_along(giant->vector, giant->curvature, point);
}

/* The point, moved to the height over the surface. */
static struct dvec3 at_height(const struct drawn *drawn, struct dvec3 point, double height)
{
    if (!drawn->is_giant)
        return dvec3_along(drawn->vector, drawn->number + height,
                           dvec3_unit(dvec3_subtract(point, drawn->vector)));
    for (int i = 0; i < 4; ++i) {
        struct dvec3 gradient = gradient_at(drawn, point);
        double off = dvec3_dot(dvec3_along(drawn->vector, drawn->curvature / 2, point), point) -
                     drawn->number - height;
        point = dvec3_along(point, -off / dvec3_dot(gradient, gradient), gradient);
    }
    return point;
}

static struct drawn draw_sphere(struct random *random, const struct PackedSphere *sphere)
{
    struct drawn drawn = {.vector = widen(vector_of(sphere->center_radius)),
                          .number = (double)sphere->center_radius.w,
                          .size = (double)sphere->center_radius.w};
    drawn.normal = random_direction(random);
    drawn.on = dvec3_along(drawn.vector, drawn.number, drawn.normal);
    drawn.tangent = random_tangent(random, drawn.normal);
    return drawn;
}

/* Near the origin of coordinates, or sometimes far out. */
static struct drawn draw_giant(struct random *random, struct PackedSphere *giant, float *curvature)
{
    const double radius = random_scale(random, one_in(random, 8) ? 1e-2 : 8, 0x1p32);
    const double height = one_in(random, 8) ? 0 : random_between(random, -1, 1);
    struct dvec3 normal = one_in(random, 4) ? random_axis(random) : random_direction(random);
    struct vec3 gradient = round_vector(dvec3_scale(1 - height / radius, normal));
    const float offset = round_number(height * (1 - height / (2 * radius)));
    *giant = (struct PackedSphere){.center_radius = {gradient.x, gradient.y, gradient.z, offset}};
    *curvature = (float)(1 / radius);
    struct drawn drawn = {true, widen(gradient), (double)offset, (double)*curvature, .size = 1};
    const double far_out = one_in(random, 8) ? random_scale(random, 1, 1e3) : 1;
    drawn.on = at_height(&drawn, dvec3_scale(far_out, random_point(random)), 0);
    drawn.normal = dvec3_unit(gradient_at(&drawn, drawn.on));
    drawn.tangent = random_tangent(random, drawn.normal);
    return drawn;
}

static struct drawn draw(struct random *random, struct PackedSphere *sphere, float *curvature)
{
    if (random->promises.giant)
        return draw_giant(random, sphere, curvature);
    *sphere = random_sphere(random);
    return draw_sphere(random, sphere);
}

static struct dvec3 random_inside(struct random *random, const struct drawn *drawn)
{
    if (!drawn->is_giant)
        return random_away(random, drawn->vector, drawn->size * random_between(random, 0, 1));
    struct dvec3 point = random_point(random);
    return at_height(drawn, point, -random_scale(random, 1e-6, 1));
}

/* What may be seen from all around, at it or a little beside it. */
static struct dvec3 random_aim(struct random *random, const struct drawn *drawn)
{
    return drawn->is_giant
               ? drawn->on
               : dvec3_along(drawn->vector, drawn->size * random_between(random, 0, 1.2), drawn->normal);
}

/* Somewhere; over a giant. */
static struct dvec3 random_outside(struct random *random, const struct drawn *drawn)
{
    struct dvec3 point = random_point(random);
    return drawn->is_giant ? at_height(drawn, point, random_scale(random, 1e-3, 2)) : point;
}

/* Along a direction in which all numbers have few digits, exactly tangent to the sphere, which is rounded. */
static struct dvec3 exact_tangent(struct PackedSphere *sphere, const struct drawn *drawn,
                                  struct dvec3 direction)
{
    const double radius = exp2(rint(fmax(log2(drawn->number), -6)));
    const struct dvec3 center = {rint(drawn->vector.x * 64) / 64, rint(drawn->vector.y * 64) / 64,
                                 rint(drawn->vector.z * 64) / 64};
    const struct vec3 rounded = round_vector(center);
    sphere->center_radius = (layout_vec4){rounded.x, rounded.y, rounded.z, (float)radius};
    return dvec3_along(dvec3_along(center, -4 * radius, direction), radius,
                       (struct dvec3){direction.y, direction.z, direction.x});
}

/* A ray to, from, along, beside or within it, which is surface 0. */
static RayRecord ray_at(struct random *random, const struct drawn *drawn, struct PackedSphere *sphere)
{
    struct dvec3 origin = drawn->on, direction = random_direction(random);
    RayRecord ray = {.surface = NO_SURFACE};
    switch (random_below(random, 20)) {
    case 0: /* leaves it */
    case 1:
        ray.surface = 0;
        break;
    case 2: /* leaves it and grazes */
        direction =
            dvec3_unit(dvec3_along(drawn->tangent, random_signed(random, 1e-12, 1e-2), drawn->normal));
        ray.surface = 0;
        break;
    case 3: /* tangent but for rounding */
    case 4:
        origin = dvec3_along(drawn->on, -drawn->size * random_scale(random, 1e-3, 1e3), drawn->tangent);
        direction = drawn->tangent;
        break;
    case 5: /* exactly tangent; or about as flat to a giant as the smallest slope that counts */
        direction = dvec3_along(drawn->tangent, random_signed(random, 0x1p-52, 0x1p-48), drawn->normal);
        if (!drawn->is_giant) {
            direction = random_axis(random);
            origin = exact_tangent(sphere, drawn, direction);
        }
        break;
    case 6: /* from close by, on either side */
        origin = dvec3_along(drawn->on, drawn->size * random_signed(random, 1e-12, 1e-3), drawn->normal);
        sphere->tags.HOLDS_RAYS = random_bool(random);
        break;
    case 7: /* from inside */
    case 8:
        origin = random_inside(random, drawn);
        sphere->tags.HOLDS_RAYS = 1;
        break;
    case 9: /* from the centre; or from inside, along a giant's surface */
        origin = drawn->is_giant ? random_inside(random, drawn) : drawn->vector;
        direction = drawn->tangent;
        sphere->tags.HOLDS_RAYS = 1;
        break;
    case 10: /* from a point on it that belongs to another surface */
        ray.surface = 7;
        sphere->tags.HOLDS_RAYS = random_bool(random);
        break;
    case 11: /* straight down, up or away */
        origin = dvec3_along(drawn->on, drawn->size * random_scale(random, 1e-3, 1e3), drawn->normal);
        direction = dvec3_scale(random_sign(random), drawn->normal);
        break;
    case 12: /* from far away */
        origin = random_away(random, drawn->on, drawn->size * random_scale(random, 1e2, 1e6));
        direction = dvec3_unit(dvec3_subtract(random_aim(random, drawn), origin));
        break;
    case 13: /* along an axis, through the middle of what it is aimed at */
        direction = random_axis(random);
        origin = dvec3_along(drawn->is_giant ? drawn->on : drawn->vector,
                             -drawn->size * random_between(random, 1, 10), direction);
        break;
    default: /* aimed at it */
        origin = random_outside(random, drawn);
        direction = dvec3_unit(dvec3_subtract(random_aim(random, drawn), origin));
    }
    ray.inward = ray.surface == 0 && dvec3_dot(direction, drawn->normal) < 0;
    if (random->promises.never_entered) {
        sphere->tags.HOLDS_RAYS = 0;
        ray.inward = false;
    }
    ray.origin = round_vector(origin);
    ray.direction = round_vector(direction);
    return ray;
}

RayRecord ray_at_sphere(struct random *random, struct PackedSphere *sphere)
{
    const struct drawn drawn = draw_sphere(random, sphere);
    return ray_at(random, &drawn, sphere);
}

void generate_meet_sphere(struct random *random, meet_sphere_input *input)
{
    const struct drawn drawn = draw(random, &input->sphere, &input->curvature);
    input->ray = ray_at(random, &drawn, &input->sphere);
}

static SegmentRecord segment_at(struct random *random, const struct drawn *drawn, layout_ivec4 *tags)
{
    struct dvec3 from = random_outside(random, drawn), to = random_point(random);
    int surface = NO_SURFACE;
    bool inward = false;
    switch (random_below(random, 20)) {
    case 0: /* leaves it, to a light anywhere */
    case 1:
        from = drawn->on;
        surface = 0;
        inward = random_bool(random);
        if (inward && random_bool(random))
            to = random_inside(random, drawn);
        tags->HOLDS_LIGHTS = inward || random_bool(random);
        break;
    case 2: /* leaves it and grazes */
        from = drawn->on;
        to = dvec3_along(from, drawn->size * random_scale(random, 1e-3, 1e3), drawn->tangent);
        surface = 0;
        inward = random_bool(random);
        break;
    case 3: /* passes as a tangent */
    case 4:
        from = dvec3_along(drawn->on, -drawn->size * random_scale(random, 1e-3, 1e3), drawn->tangent);
        to = dvec3_along(drawn->on, drawn->size * random_scale(random, 1e-3, 1e3), drawn->tangent);
        break;
    case 5: /* light on it, or close by */
        to = dvec3_along(drawn->on, random_bool(random) ? 0 : drawn->size * random_signed(random, 1e-9, 1e-3),
                         drawn->normal);
        tags->HOLDS_LIGHTS = random_bool(random);
        break;
    case 6: /* light inside */
        to = random_inside(random, drawn);
        tags->HOLDS_LIGHTS = 1;
        break;
    case 7: /* point inside */
        from = random_inside(random, drawn);
        tags->HOLDS_RAYS = 1;
        tags->HOLDS_LIGHTS = random_bool(random);
        break;
    case 8: /* both inside */
        from = random_inside(random, drawn);
        to = random_inside(random, drawn);
        tags->HOLDS_RAYS = tags->HOLDS_LIGHTS = 1;
        break;
    case 9: /* light about as far as the closest approach, which is in the sphere or beside it; or both close
             * to a giant, with its back in between */
        to = random_aim(random, drawn);
        from = dvec3_along(to, random_scale(random, 1e-2, 10), drawn->tangent);
        if (drawn->is_giant) {
            from = dvec3_along(drawn->on, random_scale(random, 1e-7, 1e-1), drawn->normal);
            to = dvec3_along(drawn->on, random_scale(random, 1, 1e4), drawn->tangent);
            to = at_height(drawn, to, random_scale(random, 1e-7, 1e-1));
        }
        break;
    case 10: /* from a point on it that belongs to another surface */
        from = drawn->on;
        surface = 5;
        tags->HOLDS_RAYS = random_bool(random);
        break;
    case 11: /* ends before it */
        to = dvec3_along(drawn->on, drawn->size * random_between(random, 0, 0.01), drawn->normal);
        from = dvec3_along(to, drawn->size * random_scale(random, 1e-3, 10), drawn->normal);
        break;
    case 12: /* both outside */
        to = random_outside(random, drawn);
        break;
    default: /* aimed at its neighbourhood, ending before it, in it or behind */
        to = random_aim(random, drawn);
        to = dvec3_along(from, random_between(random, 0.5, 3), dvec3_subtract(to, from));
    }
    if (random->promises.never_entered) {
        tags->HOLDS_RAYS = tags->HOLDS_LIGHTS = 0;
        inward = false;
    }
    return connect_points(from, to, surface, inward);
}

void generate_sphere_shadows(struct random *random, sphere_shadows_input *input)
{
    const struct drawn drawn = draw(random, &input->sphere, &input->curvature);
    input->segment = segment_at(random, &drawn, &input->sphere.tags);
}
