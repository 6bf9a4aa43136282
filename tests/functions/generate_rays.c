/* Rays at planes, and at all. */
#include "generate.h"

struct PackedPlane random_plane(struct random *random)
{
    struct dvec3 direction = random_bool(random) ? random_axis(random) : random_direction(random);
    double sign = random_sign(random);
    if (random->promises.axis != 0)
        direction =
            (struct dvec3){random->promises.axis == 1 ? sign : 0, random->promises.axis == 2 ? sign : 0,
                           random->promises.axis == 3 ? sign : 0};
    struct vec3 normal = round_vector(direction);
    float offset = one_in(random, 8) ? 0 : round_number(random_between(random, -1, 1));
    struct PackedPlane plane = {.normal_offset = {normal.x, normal.y, normal.z, offset}};
    if (!random->promises.opaque_planes && random_bool(random))
        plane.surface.tags.SURFACE_KIND = KIND_TRANSPARENT;
    plane.surface.tags.CASTS_SHADOWS =
        plane.surface.tags.SURFACE_KIND == KIND_TRANSPARENT || random_bool(random);
    return plane;
}

struct dvec3 nearest_to_origin(const struct PackedPlane *plane)
{
    return dvec3_scale((double)plane->normal_offset.w, dvec3_unit(widen(vector_of(plane->normal_offset))));
}

struct dvec3 random_in_plane(struct random *random, const struct PackedPlane *plane, struct dvec3 start,
                             double distance)
{
    return random_aside(random, dvec3_unit(widen(vector_of(plane->normal_offset))), start, distance);
}

static RayRecord ray_at_plane(struct random *random, const struct PackedPlane *plane, int surface)
{
    struct dvec3 normal = dvec3_unit(widen(vector_of(plane->normal_offset)));
    struct dvec3 tangent = random_tangent(random, normal);
    struct dvec3 on_plane =
        random_in_plane(random, plane, nearest_to_origin(plane), random_between(random, -2, 2));
    struct dvec3 origin = random_point(random), direction = random_direction(random);
    RayRecord ray = {.surface = NO_SURFACE};
    switch (random_below(random, 16)) {
    case 0: /* parallel but for rounding */
        direction = tangent;
        break;
    case 1: /* grazes */
        direction = dvec3_unit(dvec3_along(tangent, random_signed(random, 1e-12, 1e-2), normal));
        break;
    case 2: /* about as parallel as the smallest slope that counts */
        direction = dvec3_along(tangent, PARALLEL * random_signed(random, 0.5, 1.5), normal);
        break;
    case 3: /* from it */
        origin = on_plane;
        ray.surface = surface;
        break;
    case 4: /* from a point on it that belongs to another surface */
        origin = on_plane;
        break;
    case 5: /* from close by, on either side */
        origin = dvec3_along(on_plane, random_signed(random, 1e-9, 1e-3), normal);
        break;
    case 6: /* perpendicular */
        direction = dvec3_scale(random_sign(random), normal);
        break;
    case 7: /* from far away */
        origin = dvec3_along(on_plane, random_signed(random, 1e2, 1e6), direction);
        break;
    default:
        break;
    }
    ray.origin = round_vector(origin);
    ray.direction = round_vector(direction);
    return ray;
}

void generate_meet_plane(struct random *random, meet_plane_input *input)
{
    input->plane = random_plane(random);
    input->ray = ray_at_plane(random, &input->plane, 1);
}

/* A ray at a plane that touches the sphere where the ray meets it first. */
static RayRecord ray_at_tangent_plane(const struct PackedSphere *sphere, struct PackedPlane *plane)
{
    struct vec3 center = vector_of(sphere->center_radius), normal = vector_of(plane->normal_offset);
    float radius = sphere->center_radius.w;
    plane->normal_offset.w = dot(normal, center) + radius;
    return (RayRecord){
        .origin = round_vector(dvec3_along(widen(center), 3 * (double)radius, widen(normal))),
        .direction = negate(normal),
        .surface = NO_SURFACE,
    };
}

/* Two spheres and two planes, often the same twice, so that there are ties for the file order to decide. */
void generate_nearest_hit(struct random *random, nearest_hit_input *input)
{
    layout_ivec4 *tags[] = {&input->sphere_0.tags, &input->sphere_1.tags, &input->plane_0.surface.tags,
                            &input->plane_1.surface.tags};
    input->sphere_0 = random_sphere(random);
    input->sphere_1 = random_sphere(random);
    input->plane_0 = random_plane(random);
    input->plane_1 = random_plane(random);
    input->ray = random_bool(random) ? ray_at_sphere(random, &input->sphere_0)
                                     : ray_at_plane(random, &input->plane_0, 2);
    if (random_bool(random))
        input->sphere_1 = input->sphere_0;
    if (random_bool(random))
        input->plane_1 = input->plane_0;
    if (one_in(random, 4) && input->ray.surface == NO_SURFACE)
        input->ray = ray_at_tangent_plane(&input->sphere_0, &input->plane_0);
    for (int i = 0; i < 4; ++i)
        tags[i]->FILE_ORDER = i;
    for (unsigned i = 3; i > 0 && !random->promises.in_order; --i) {
        unsigned other = random_below(random, i + 1);
        int file_order = tags[i]->FILE_ORDER;
        tags[i]->FILE_ORDER = tags[other]->FILE_ORDER;
        tags[other]->FILE_ORDER = file_order;
    }
}
