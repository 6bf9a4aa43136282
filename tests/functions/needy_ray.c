#include "needy_ray.h"

#include <string.h>

#include "tracer/sphere_records.h"

static const float slack = 0x1p-19F; /* SLACK of shaders/hierarchy.glsl */

/* The direction's length is less than 1 by so many unit roundoffs, of the 4.5 that a ray's may be: what of it
 * is left in the vector from the closest approach to the centre shortens the distance. */
static const double shortness = 4.4, most_shortness = 4.5;

static void to_array(struct dvec3 v, double array[3])
{
    array[0] = v.x;
    array[1] = v.y;
    array[2] = v.z;
}

static bool draw(struct random *random, struct needy_ray *needy)
{
    double way[3], aside[3], center[3], origin[3];
    to_array(random_direction(random), way);
    to_array(random_point(random), aside);
    const double distance = random_between(random, 0.5, 1), radius = random_scale(random, 1e-3, 0.3);
    const double share = random_between(random, 0.4, 0.6);
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        axis = fabs(way[a]) > fabs(way[axis]) ? a : axis;
    for (int a = 0; a < 3; ++a) {
        const double touched = share * distance * way[a] + 0.01 * aside[a];
        center[a] = touched + (a == axis ? copysign(radius, way[a]) : 0);
        origin[a] = touched - distance * way[a];
    }
    const struct dvec3 direction =
        dvec3_scale(1 - shortness * 0x1p-24, (struct dvec3){way[0], way[1], way[2]});
    needy->ray = (struct ray){.origin = round_vector((struct dvec3){origin[0], origin[1], origin[2]}),
                              .direction = round_vector(direction),
                              .surface = NO_SURFACE};
    for (int i = 0; i < NEEDY_SPHERES; ++i)
        needy->spheres[i] = (struct PackedSphere){
            {(float)center[0], (float)center[1], (float)center[2], (float)radius / (float)(i > 1 ? i : 1)},
            {.FILE_ORDER = i > 0 ? i : NEEDY_SPHERES}};
    needy->surfaces[0].tags.OTHERS_BEFORE = NEEDY_SPHERES - 1;
    return fabs(dvec3_length(widen(needy->ray.direction)) - 1) <= most_shortness * 0x1p-24;
}

/* As enters() of hierarchy.glsl, with so much slack. */
static bool enters(const struct ray *ray, uint32_t (*records)[4], const uint32_t box[4], float units,
                   float limit)
{
    const float origin[3] = {ray->origin.x, ray->origin.y, ray->origin.z},
                direction[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    float grid_origin[4], grid_step[4], entry = 0, exit = limit;
    memcpy(grid_origin, records[GRID_ORIGIN], sizeof grid_origin);
    memcpy(grid_step, records[GRID_STEP], sizeof grid_step);
    const float largest = fmaxf(fmaxf(fabsf(origin[0]), fabsf(origin[1])), fabsf(origin[2])) + grid_origin[3];
    for (int a = 0; a < 3; ++a) {
        const float inverse = 1 / direction[a], scale = grid_step[a] * inverse;
        const float lo = (grid_origin[a] - (origin[a] + units * largest)) * inverse,
                    hi = (grid_origin[a] - (origin[a] - units * largest)) * inverse;
        const float at_lo = (float)(box[a] & 0xffff) * scale + lo, at_hi = (float)(box[a] >> 16) * scale + hi;
        entry = fmaxf(entry, fminf(at_lo, at_hi));
        exit = fminf(exit, fmaxf(at_lo, at_hi));
    }
    return entry <= exit;
}

/* Whether the larger of the root's two boxes, which has the sphere that is met, is not entered in time. */
static bool is_hidden(struct needy_ray *needy, float units)
{
    uint32_t records[64][4], words[128];
    struct hit hit;
    sphere_records_write(&needy->scene, records, words);
    const uint32_t *left = records[HEAD_RECORDS], *right = records[HEAD_RECORDS + 1];
    const bool left_is_larger = (left[0] >> 16) - (left[0] & 0xffff) > (right[0] >> 16) - (right[0] & 0xffff);
    return find_hit(&needy->scene, &needy->ray, &hit) && hit.surface == 1 &&
           !enters(&needy->ray, records, left_is_larger ? left : right, units, hit.distance);
}

bool needy_ray_create(struct random *random, float share, struct needy_ray *needy)
{
    *needy = (struct needy_ray){.surfaces = {{.tags.OTHERS_BEFORE = 0}}};
    if (!draw(random, needy) ||
        hierarchy_build(needy->spheres, 1, NEEDY_SPHERES - 1, &needy->hierarchy) != STATUS_DONE)
        return false;
    needy->scene = (struct packed_scene){.sphere_count = NEEDY_SPHERES,
                                         .looped_spheres = 1,
                                         .surface_count = 1,
                                         .spheres = needy->spheres,
                                         .surfaces = needy->surfaces,
                                         .hierarchy = &needy->hierarchy};
    if (is_hidden(needy, share * slack))
        return true;
    hierarchy_destroy(&needy->hierarchy);
    return false;
}
