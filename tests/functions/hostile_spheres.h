#ifndef HOSTILE_SPHERES_H
#define HOSTILE_SPHERES_H

#include "geometry.h"
#include "random.h"

enum { MOST_HOSTILE_SPHERES = 96, MOST_HOSTILE_LOOPED = 8 };

/* Spheres that a tree of balls may get wrong, with a tree and without. */
struct hostile_scene {
    struct PackedSphere spheres[MOST_HOSTILE_SPHERES];
    struct PackedSurface surfaces[MOST_HOSTILE_LOOPED];
    struct sphere_tree *tree;
    struct packed_scene with_tree, without;
    double e_origin, e_direction,
        unit; /* of rays, which pass spheres by a few times as much: see tree_line */
};

/* So many spheres (0: some), with radii over ten decades, in clouds, in one plane, on one line, around one
 * point, in each other, touching and on a grid. Some are looped over, with places of their own in the file;
 * the others are in order. */
void hostile_scene_create(struct random *random, unsigned count, struct hostile_scene *scene);
void hostile_scene_destroy(struct hostile_scene *scene);

/* Gives its rays errors like those that a ray in float gathers on its way. */
void hostile_scene_blur(struct random *random, struct hostile_scene *scene);

/* A ray to, from, beside or within one of them. It may begin 2^50 away. */
struct ray hostile_ray(struct random *random, const struct hostile_scene *scene);

/* A segment as a shadow ray's, likewise; it may end in one of them or beside its middle. */
struct segment hostile_segment(struct random *random, const struct hostile_scene *scene);

#endif
