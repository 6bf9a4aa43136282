/* Directions at mirrors and glass, matte points under lights. */
#include "generate.h"

/* A ray that meets a surface at an angle of about this cosine. */
static reflect_input meet_at(struct random *random, double cos_in)
{
    struct dvec3 normal = one_in(random, 4) ? random_axis(random) : random_direction(random);
    struct dvec3 tangent = random_tangent(random, normal);
    struct dvec3 along = dvec3_along(dvec3_scale(-cos_in, normal), sqrt(1 - cos_in * cos_in), tangent);
    reflect_input meeting = {.direction = round_vector(along), .normal = round_vector(normal)};
    meeting.cos_in = at_least_zero(-dot(meeting.direction, meeting.normal));
    if (random_bool(random))
        meeting.cos_in = round_number(cos_in); /* an edge would be lost in the rounding of directions */
    return meeting;
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

void generate_reflect(struct random *random, reflect_input *input)
{
    *input = meet_at(random, random_cosine(random));
}

void generate_refract(struct random *random, refract_input *input)
{
    static const double indices[] = {1, 1 + 1e-6, 1 - 1e-6, 1 + 0x1p-23, 0.75, 1.3, 1.5, 2.42};
    double ior = random_bool(random) ? indices[random_below(random, sizeof indices / sizeof *indices)]
                                     : random_scale(random, 0.3, 4);
    bool entering = random_bool(random);
    double eta = entering ? 1 / ior : ior;
    double kappa = entering ? (ior - 1) * (ior + 1) / (ior * ior) : (1 - ior) * (1 + ior);
    double cos_in = random_cosine(random);
    if (one_in(random, 4) && kappa < 0) /* about the critical angle */
        cos_in = fmin(1, (double)random_neighbour(random, round_number(sqrt(-kappa) / eta)));
    else if (one_in(random, 8)) /* about Brewster's angle */
        cos_in = (double)random_neighbour(random, round_number(eta / sqrt(1 + eta * eta)));
    reflect_input meeting = meet_at(random, cos_in);
    *input = (refract_input){meeting.direction, meeting.normal, meeting.cos_in, round_number(eta),
                             round_number(kappa)};
}

/* A matte point on the sphere (surface 0, either side), on the plane (1) or on some other surface. *normal
 * faces the ray. */
static MatteRecord random_matte(struct random *random, const struct PackedSphere *sphere,
                                const struct PackedPlane *plane, struct dvec3 *facing_normal)
{
    struct dvec3 normal = random_direction(random);
    struct dvec3 point = random_point(random);
    int surface = (int)random_below(random, 3);
    bool inward = false;
    if (surface == 0) {
        inward = random_bool(random);
        point = dvec3_along(widen(vector_of(sphere->center_radius)), (double)sphere->center_radius.w, normal);
        normal = inward ? dvec3_scale(-1, normal) : normal;
    } else if (surface == 1) {
        normal = widen(vector_of(plane->normal_offset));
        point = random_in_plane(random, plane, nearest_to_origin(plane), random_between(random, -1, 1));
    }
    double cos_out = one_in(random, 4) ? random_scale(random, 1e-9, 1e-2) : random_between(random, 0, 1);
    struct dvec3 ray = dvec3_along(dvec3_scale(-cos_out, normal), sqrt(1 - cos_out * cos_out),
                                   random_tangent(random, dvec3_unit(normal)));
    double roughness = one_in(random, 8) ? 0 : random_between(random, 0, 1.6), square = roughness * roughness;
    *facing_normal = normal;
    return (MatteRecord){
        .point = round_vector(point),
        .normal = round_vector(normal),
        .ray_direction = round_vector(ray),
        .cos_out = -dot(round_vector(normal), round_vector(ray)),
        .surface = surface,
        .inward = inward,
        .a = round_number(1 - 0.5 * square / (square + 0.33)),
        .b = random->promises.lambert ? 0 : round_number(0.45 * square / (square + 0.09)),
    };
}

void generate_oren_nayar(struct random *random, oren_nayar_input *input)
{
    struct PackedSphere sphere = random_sphere(random);
    struct PackedPlane plane = random_plane(random);
    struct dvec3 normal;
    input->matte = random_matte(random, &sphere, &plane, &normal);
    double cos_in = random_bool(random) ? random_between(random, 0, 1) : random_scale(random, 1e-12, 1);
    input->cos_in = round_number(cos_in);
    input->to_light = round_vector(dvec3_along(dvec3_scale(cos_in, normal), sqrt(1 - cos_in * cos_in),
                                               random_tangent(random, dvec3_unit(normal))));
}

/* A matte point in a scene of a sphere that rays and lights may be inside of, and a plane. */
static MatteRecord random_matte_scene(struct random *random, struct PackedSphere *sphere,
                                      struct PackedPlane *plane, struct dvec3 *facing_normal)
{
    *sphere = random_sphere(random);
    *plane = random_plane(random);
    sphere->tags.HOLDS_RAYS = random_bool(random);
    sphere->tags.HOLDS_LIGHTS = random_bool(random);
    return random_matte(random, sphere, plane, facing_normal);
}

void generate_point_light(struct random *random, point_light_input *input)
{
    struct dvec3 normal;
    input->matte = random_matte_scene(random, &input->sphere, &input->plane, &normal);
    struct dvec3 point = widen(input->matte.point), light = random_point(random);
    switch (random_below(random, 12)) {
    case 0: /* on the surface's tangent plane but for rounding */
        light = random_aside(random, dvec3_unit(normal), point, random_scale(random, 1e-3, 10));
        break;
    case 1: /* at the point */
        light = point;
        break;
    case 2: /* about as near as a light that does not shine */
        light = dvec3_along(point, random_scale(random, 1e-12, 1e-3), normal);
        break;
    case 3: /* on the plane */
        light = random_in_plane(random, &input->plane, nearest_to_origin(&input->plane),
                                random_between(random, -2, 2));
        break;
    case 4: /* in or on the sphere */
        light = random_away(random, widen(vector_of(input->sphere.center_radius)),
                            (double)input->sphere.center_radius.w * fmin(1, random_between(random, 0, 2)));
        break;
    case 5: /* straight above */
        light = dvec3_along(point, random_scale(random, 1e-3, 10), normal);
        break;
    default: /* above */
        light = dvec3_along(light, 2, normal);
    }
    input->light = round_vector(light);
}

static layout_vec4 round_vec4(struct dvec3 v)
{
    struct vec3 rounded = round_vector(v);
    return (layout_vec4){rounded.x, rounded.y, rounded.z, 0};
}

void generate_quad_light(struct random *random, quad_light_input *input)
{
    struct dvec3 normal;
    input->matte = random_matte_scene(random, &input->sphere, &input->plane, &normal);
    struct dvec3 corner = random_point(random);
    struct dvec3 u = random_away(random, (struct dvec3){0}, random_scale(random, 1e-3, 2));
    struct dvec3 v = random_away(random, (struct dvec3){0}, random_scale(random, 1e-3, 2));
    if (one_in(random, 4)) /* the point lies in the light's plane */
        corner = dvec3_along(widen(input->matte.point), random_between(random, -1, 1), u);
    else if (random_below(random, 4) != 0) /* shines on the point */
        corner = dvec3_along(corner, 2, normal);
    input->light = (struct PackedQuadLight){
        .corner = round_vec4(corner),
        .edge_u = round_vec4(u),
        .edge_v = round_vec4(v),
        .area_normal = round_vec4(dvec3_cross(u, v)),
        .radiance = {(float)random_scale(random, 1e-3, 1e3), 1, 0, 0},
    };
    input->seed = (int)(uint32_t)random_bits(random);
    input->pixel_sample = (int)random_below(random, 1000);
}
