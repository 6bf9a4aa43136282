#ifndef VKWHITTED_SCENE_HIERARCHY_H
#define VKWHITTED_SCENE_HIERARCHY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"
#include "packed_scene.h"

/* A binary tree of boxes around spheres, built by the surface-area heuristic (MacDonald and Booth,
 * "Heuristics for Ray Tracing Using Space Subdivision", The Visual Computer 6, 1990) with bins (Wald, "On
 * Fast Construction of SAH-based Bounding Volume Hierarchies", 2007). */

struct box {
    float lo[3], hi[3]; /* rounded outwards */
};

static inline float box_half_area(const struct box *box)
{
    float x = box->hi[0] - box->lo[0], y = box->hi[1] - box->lo[1], z = box->hi[2] - box->lo[2];
    return x * y + y * z + z * x;
}

struct hierarchy_node {
    struct box box;
    uint32_t left;   /* of two children, of which the right one is next to it; 0: a leaf */
    uint32_t sphere; /* of a leaf: its index */
};

/* The root is node 0. Each leaf has one sphere. */
struct hierarchy {
    struct hierarchy_node *nodes;
    uint32_t node_count;
    unsigned owners;          /* packed scenes that share it, where such own it */
    struct sphere_tree *tree; /* the reference's own over the same spheres; NULL: not wanted yet */
};

/* Of spheres first to first + count - 1 of the scene; on all processors. On STATUS_DONE the caller frees it
 * with hierarchy_destroy(); otherwise it is empty: STATUS_UNABLE (reported) without memory. */
enum status hierarchy_build(const struct PackedSphere *spheres, uint32_t first, uint32_t count,
                            struct hierarchy *hierarchy);
void hierarchy_destroy(struct hierarchy *hierarchy);

/* Calls visit for each sphere whose box touches the box, until it returns false. */
typedef bool hierarchy_visitor(void *user, uint32_t sphere);
void hierarchy_visit(const struct hierarchy *hierarchy, struct box box, hierarchy_visitor *visit, void *user);

#endif
