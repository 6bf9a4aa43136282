/* Many spheres: a binary tree of balls around them, which says which spheres a ray or a segment may meet. It
 * is the reference's own, in double for every precision, and drops only what the tracer is certain not to
 * meet with all its roundings: NUMERICS.md, "Many spheres". */
#ifndef REFERENCE_SPHERE_TREE_H
#define REFERENCE_SPHERE_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "packed_scene.h"

struct sphere_tree;

/* Is told how many spheres more have found their place, by one thread at a time. */
typedef void tree_progress(void *user, uint32_t spheres);

/* Of spheres first to end - 1, one at least, on so many threads; 12 to 20 bytes a sphere, and as many again
 * while it is built. progress may be NULL. NULL without memory; otherwise the caller frees it with
 * sphere_tree_destroy(). */
struct sphere_tree *sphere_tree_create(const struct PackedSphere *spheres, int first, int end, int threads,
                                       tree_progress *progress, void *user);
void sphere_tree_destroy(struct sphere_tree **tree);

struct tree_vector {
    double x, y, z;
};

/* A ray, or a segment from its origin. */
struct tree_line {
    struct tree_vector origin, direction; /* of a length near 1 */
    double e_origin, e_direction;         /* how far they may be off: length, radians */
    double unit;                          /* unit roundoff of what the tracer computes of it */
    bool has_end;                         /* spheres that the end lies in are met, too */
    struct tree_vector end;
    double e_end;
};

enum { NO_MORE_SPHERES = -1, DEEPEST_SPHERE_TREE = 32 };

/* A walk through the tree, nearer balls first. */
struct sphere_walk {
    double limit;          /* on the distance to where a sphere is met */
    struct tree_line line; /* the caller may lower the limit, and the errors and the unit in here */
    const struct sphere_tree *tree;
    double stretch, inverse_squared; /* of the direction's length */
    struct {
        uint32_t node;
        double entry; /* no sphere in it is met at a smaller distance */
    } stack[DEEPEST_SPHERE_TREE];
    int depth;
    uint32_t next, last; /* of the current leaf's spheres */
};

struct sphere_walk sphere_walk_begin(const struct sphere_tree *tree, const struct tree_line *line,
                                     double limit);

/* The number of another sphere that the line may meet at a distance up to the limit, or NO_MORE_SPHERES. */
int sphere_walk_next(struct sphere_walk *walk);

#endif
