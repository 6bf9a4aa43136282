#ifndef NEEDY_RAY_H
#define NEEDY_RAY_H

#include "geometry.h"
#include "random.h"
#include "scene/hierarchy.h"

enum { NEEDY_SPHERES = 5 };

/* A ray that meets its sphere where that touches a side of its box, and of which errors conspire: the
 * computed distance is so short that the box, on a plane of the grid, would be entered behind it with a share
 * of the slack that boxes have (NUMERICS.md, "Many spheres: the device's boxes"). The sphere that it meets
 * comes first in the file and lies in a box with others; another, which is looped over, coincides with it and
 * comes last. So the first one is found only if its box is. */
struct needy_ray {
    struct PackedSphere spheres[NEEDY_SPHERES];
    struct PackedSurface surfaces[2];
    struct packed_scene scene;
    struct hierarchy hierarchy; /* to be destroyed */
    struct ray ray;
};

/* Draws one; false where it needs less than that share of the slack. */
bool needy_ray_create(struct random *random, float share, struct needy_ray *needy);

#endif
