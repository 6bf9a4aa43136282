/* Directions at mirrors and glass, matte points under lights. */
#include "generate.h"

struct interface {
    struct vec3 direction, normal;
    real cos_in;
};

/* A ray that meets a surface at an angle of about this cosine. */
static struct interface meet_at(struct random *random, double cos_in)
{
    struct dvec3 normal = random_below(random, 4) == 0 ? random_axis(random) : random_direction(random);
    struct dvec3 tangent = random_tangent(random, normal);
    struct dvec3 along = dvec3_along(dvec3_scale(-cos_in, normal), sqrt(1 - cos_in * cos_in), tangent);
    struct interface interface = {.direction = round_vector(along), .normal = round_vector(normal)};
    interface.cos_in = at_least_zero(-dot(interface.direction, interface.normal));
    if (random_bool(random))
        interface.cos_in = round_number(cos_in); /* an edge would be lost in the rounding of directions */
    return interface;
}

static void put_interface(struct word_writer *inputs, const struct interface *interface)
{
    put_vector(inputs, "direction", interface->direction);
    put_vector(inputs, "normal", interface->normal);
    put_real(inputs, "cos_in", interface->cos_in);
}

/* cos_in^2 stays a normal number, unless it is 0. */
static double random_cosine(struct random *random)
{
    switch (random_below(random, 8)) {
    case 0:
        return 0;
    case 1:
        return 1;
    case 2: /* grazes */
        return random_scale(random, 1e-12, 1e-2);
    case 3: /* nearly perpendicular */
        return 1 - random_scale(random, 1e-16, 1e-3);
    default:
        return random_between(random, 0, 1);
    }
}

void generate_reflection(struct random *random, const struct promises *promises, struct word_writer *inputs)
{
    (void)promises;
    struct interface interface = meet_at(random, random_cosine(random));
    put_interface(inputs, &interface);
}

void generate_refraction(struct random *random, const struct promises *promises, struct word_writer *inputs)
{
    (void)promises;
    static const double indices[] = {1, 1 + 1e-6, 1 - 1e-6, 1 + 0x1p-23, 0.75, 1.3, 1.5, 2.42};
    double ior = random_bool(random) ? indices[random_below(random, sizeof indices / sizeof *indices)]
                                     : random_scale(random, 0.3, 4);
    bool entering = random_bool(random);
    double eta = entering ? 1 / ior : ior;
    double kappa = entering ? (ior - 1) * (ior + 1) / (ior * ior) : (1 - ior) * (1 + ior);
    double cos_in = random_cosine(random);
    if (random_below(random, 4) == 0 && kappa < 0) /* about the critical angle */
        cos_in = fmin(1, (double)random_neighbour(random, round_number(sqrt(-kappa) / eta)));
    else if (random_below(random, 8) == 0) /* about Brewster's angle */
        cos_in = (double)random_neighbour(random, round_number(eta / sqrt(1 + eta * eta)));
    struct interface interface = meet_at(random, cos_in);
    put_interface(inputs, &interface);
    put_real(inputs, "eta", round_number(eta));
    put_real(inputs, "kappa", round_number(kappa));
}

static void put_roughness(struct random *random, const struct promises *promises, struct word_writer *inputs)
{
    double roughness = random_below(random, 8) == 0 ? 0 : random_between(random, 0, 1.6);
    double square = roughness * roughness;
    put_real(inputs, "A", round_number(1 - 0.5 * square / (square + 0.33)));
    put_real(inputs, "B", promises->lambert ? 0 : round_number(0.45 * square / (square + 0.09)));
}

struct matte_case {
    struct dvec3 normal; /* facing the ray */
    struct vec3 point;
};

/* A matte point on the sphere (surface 0, either side), on the plane (1) or on some other surface. */
static struct matte_case put_matte(struct random *random, const struct promises *promises,
                                   const struct PackedSphere *sphere, const struct PackedPlane *plane,
                                   struct word_writer *inputs)
{
    struct dvec3 normal = random_direction(random), point = random_point(random);
    int surface = (int)random_below(random, 3);
    bool inward = false;
    if (surface == 0) {
        inward = random_bool(random);
        point = dvec3_along(widen(vector_of(sphere->center_radius)), (double)sphere->center_radius.w, normal);
        normal = inward ? dvec3_scale(-1, normal) : normal;
    } else if (surface == 1) {
        normal = widen(vector_of(plane->normal_offset));
        point = dvec3_scale((double)plane->normal_offset.w, dvec3_unit(normal));
        point = random_in_plane(random, plane, point, random_between(random, -1, 1));
    }
    double cos_out =
        random_below(random, 4) == 0 ? random_scale(random, 1e-9, 1e-2) : random_between(random, 0, 1);
    struct dvec3 ray = dvec3_along(dvec3_scale(-cos_out, normal), sqrt(1 - cos_out * cos_out),
                                   random_tangent(random, dvec3_unit(normal)));
    put_vector(inputs, "point", round_vector(point));
    put_vector(inputs, "normal", round_vector(normal));
    put_vector(inputs, "ray direction", round_vector(ray));
    put_real(inputs, "cos_out", -dot(round_vector(normal), round_vector(ray)));
    put_integer(inputs, "surface", (uint32_t)surface);
    put_integer(inputs, "inward", inward);
    put_roughness(random, promises, inputs);
    return (struct matte_case){normal, round_vector(point)};
}

void generate_oren_nayar(struct random *random, const struct promises *promises, struct word_writer *inputs)
{
    struct PackedSphere sphere = random_sphere(random);
    struct PackedPlane plane = random_plane(random, promises);
    struct matte_case matte = put_matte(random, promises, &sphere, &plane, inputs);
    double cos_in = random_below(random, 2) ? random_between(random, 0, 1) : random_scale(random, 1e-12, 1);
    struct dvec3 to_light = dvec3_along(dvec3_scale(cos_in, matte.normal), sqrt(1 - cos_in * cos_in),
                                        random_tangent(random, dvec3_unit(matte.normal)));
    put_vector(inputs, "to light", round_vector(to_light));
    put_real(inputs, "cos_in", round_number(cos_in));
}

static void tag(struct random *random, const struct promises *promises, struct PackedSphere *sphere)
{
    if (!promises->never_entered) {
        sphere->surface.tags.HOLDS_RAYS = random_bool(random);
        sphere->surface.tags.HOLDS_LIGHTS = random_bool(random);
    }
}

void generate_point_light(struct random *random, const struct promises *promises, struct word_writer *inputs)
{
    struct PackedSphere sphere = random_sphere(random);
    struct PackedPlane plane = random_plane(random, promises);
    tag(random, promises, &sphere);
    struct matte_case matte = put_matte(random, promises, &sphere, &plane, inputs);
    struct dvec3 point = widen(matte.point), light = random_point(random);
    switch (random_below(random, 12)) {
    case 0: /* on the surface's tangent plane but for rounding */
        light = random_aside(random, dvec3_unit(matte.normal), point, random_scale(random, 1e-3, 10));
        break;
    case 1: /* at the point */
        light = point;
        break;
    case 2: /* about as near as a light that does not shine */
        light = dvec3_along(point, random_scale(random, 1e-12, 1e-3), matte.normal);
        break;
    case 3: /* on the plane */
        light = dvec3_scale((double)plane.normal_offset.w, widen(vector_of(plane.normal_offset)));
        light = random_in_plane(random, &plane, light, random_between(random, -2, 2));
        break;
    case 4: /* in or on the sphere */
        light = random_away(random, widen(vector_of(sphere.center_radius)),
                            (double)sphere.center_radius.w * fmin(1, random_between(random, 0, 2)));
        break;
    case 5: /* straight above */
        light = dvec3_along(point, random_scale(random, 1e-3, 10), matte.normal);
        break;
    default: /* above */
        light = dvec3_along(light, 2, matte.normal);
    }
    put_vector(inputs, "light", round_vector(light));
    put_sphere(inputs, &sphere);
    put_plane(inputs, &plane);
}

void generate_quad_light(struct random *random, const struct promises *promises, struct word_writer *inputs)
{
    struct PackedSphere sphere = random_sphere(random);
    struct PackedPlane plane = random_plane(random, promises);
    tag(random, promises, &sphere);
    struct matte_case matte = put_matte(random, promises, &sphere, &plane, inputs);
    struct dvec3 corner = random_point(random);
    struct dvec3 u = random_away(random, (struct dvec3){0}, random_scale(random, 1e-3, 2));
    struct dvec3 v = random_away(random, (struct dvec3){0}, random_scale(random, 1e-3, 2));
    if (random_below(random, 4) == 0) /* the point lies in the light's plane */
        corner = dvec3_along(widen(matte.point), random_between(random, -1, 1), u);
    else if (random_below(random, 4) != 0) /* shines on the point */
        corner = dvec3_along(corner, 2, matte.normal);
    const struct {
        const char *name;
        struct dvec3 vector;
    } parts[] = {{"corner", corner},
                 {"edge u", u},
                 {"edge v", v},
                 {"area normal", dvec3_cross(u, v)},
                 {"radiance", {random_scale(random, 1e-3, 1e3), 1, 0}}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) {
        put_vector(inputs, parts[i].name, round_vector(parts[i].vector));
        put_real(inputs, "unused", 0);
    }
    put_integer(inputs, "seed", (uint32_t)random_bits(random));
    put_integer(inputs, "pixel sample", random_below(random, 1000));
    put_sphere(inputs, &sphere);
    put_plane(inputs, &plane);
}
