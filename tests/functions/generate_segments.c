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
