#include "scene/hierarchy.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/progress.h"
#include "sphere_tree.h"

enum {
    BINS = 16,
    LEAST_TASK = 4096, /* spheres for which another thread pays */
    MOST_LEVELS = 64   /* below, halves are split by number: many spheres with one centre make long chains */
};

/* A sphere that is being sorted into the tree. */
struct leaf {
    float center[3], radius;
    uint32_t sphere;
};

static struct box nothing(void)
{
    return (struct box){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}

static inline void include(struct box *box, const float lo[3], const float hi[3])
{
    for (int a = 0; a < 3; ++a) {
        box->lo[a] = lo[a] < box->lo[a] ? lo[a] : box->lo[a];
        box->hi[a] = hi[a] > box->hi[a] ? hi[a] : box->hi[a];
    }
}

/* Rounded to nearest: good enough to choose a split by. */
static inline void include_sphere(struct box *box, const struct leaf *leaf)
{
    float lo[3], hi[3];
    for (int a = 0; a < 3; ++a) {
        lo[a] = leaf->center[a] - leaf->radius;
        hi[a] = leaf->center[a] + leaf->radius;
    }
    include(box, lo, hi);
}

static struct box box_around(const struct leaf *leaf)
{
    struct box box = nothing();
    include_sphere(&box, leaf);
    for (int a = 0; a < 3; ++a) {
        box.lo[a] = nextafterf(box.lo[a], -INFINITY);
        box.hi[a] = nextafterf(box.hi[a], INFINITY);
    }
    return box;
}

/* Where to part leaves: by the number of the bin that their centre lies in along an axis. */
struct split {
    int axis; /* -1: there is none */
    int bin;  /* the first of the right side */
    float origin[3], bins_per_length[3];
};

static inline int bin_of(const struct split *split, int axis, const struct leaf *leaf)
{
    int bin = (int)((leaf->center[axis] - split->origin[axis]) * split->bins_per_length[axis]);
    return bin < BINS ? bin : BINS - 1;
}

struct bin {
    struct box box;
    uint32_t count;
};

/* Finds the split of least cost (half area times leaves, of both sides) along an axis. */
static void choose_bin(const struct bin bins[BINS], int axis, float *least_cost, struct split *split)
{
    float right_cost[BINS];
    struct bin side = {nothing(), 0};
    for (int i = BINS - 1; i > 0; --i) {
        include(&side.box, bins[i].box.lo, bins[i].box.hi);
        side.count += bins[i].count;
        right_cost[i] = side.count > 0 ? box_half_area(&side.box) * (float)side.count : INFINITY;
    }
    side = (struct bin){nothing(), 0};
    for (int i = 1; i < BINS; ++i) {
        include(&side.box, bins[i - 1].box.lo, bins[i - 1].box.hi);
        side.count += bins[i - 1].count;
        float cost = side.count > 0 ? box_half_area(&side.box) * (float)side.count + right_cost[i] : INFINITY;
        if (cost < *least_cost) {
            *least_cost = cost;
            split->axis = axis;
            split->bin = i;
        }
    }
}

static struct split choose_split(const struct leaf *leaves, uint32_t count)
{
    struct box centers = nothing();
    for (uint32_t i = 0; i < count; ++i)
        include(&centers, leaves[i].center, leaves[i].center);
    struct split split = {.axis = -1};
    for (int a = 0; a < 3; ++a) {
        float length = centers.hi[a] - centers.lo[a];
        split.origin[a] = centers.lo[a];
        split.bins_per_length[a] = length > FLT_MIN ? fminf((float)BINS * 0.9999F / length, FLT_MAX) : 0;
    }
    struct bin bins[3][BINS];
    for (int i = 0; i < 3 * BINS; ++i)
        bins[i / BINS][i % BINS] = (struct bin){nothing(), 0};
    for (uint32_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) {
            struct bin *bin = &bins[a][bin_of(&split, a, &leaves[i])];
            include_sphere(&bin->box, &leaves[i]);
            ++bin->count;
        }
    float least_cost = INFINITY;
    for (int a = 0; a < 3; ++a)
        choose_bin(bins[a], a, &least_cost, &split);
    return split;
}

/* Parts the leaves; the number on the left side. */
static uint32_t part(struct leaf *leaves, uint32_t count, int level)
{
    struct split split = {.axis = -1};
    if (level < MOST_LEVELS && count > 2)
        split = choose_split(leaves, count);
    if (split.axis < 0)
        return count / 2;
    uint32_t left = 0, right = count;
    while (left < right) {
        if (bin_of(&split, split.axis, &leaves[left]) < split.bin) {
            ++left;
        } else {
            struct leaf leaf = leaves[--right];
            leaves[right] = leaves[left];
            leaves[left] = leaf;
        }
    }
    return left;
}

struct building {
    struct hierarchy_node *nodes;
    struct progress progress; /* in leaves */
};

/* Builds the subtree at `node` over the leaves; what is below the node takes the 2 count - 2 nodes from
 * `below` on. */
static void build(struct building *building, uint32_t node, uint32_t below, struct leaf *leaves,
                  uint32_t count, int level)
{
    struct hierarchy_node *nodes = building->nodes;
    if (count == 1) {
        nodes[node] = (struct hierarchy_node){box_around(leaves), 0, leaves->sphere};
        return;
    }
    const uint32_t left = part(leaves, count, level), right = count - left;
    const uint32_t below_right =
        below + 2 * left; /* behind the two children and what is below the left one */
#pragma omp task if (left > LEAST_TASK)
    build(building, below, below + 2, leaves, left, level + 1);
    build(building, below + 1, below_right, leaves + left, right, level + 1);
#pragma omp taskwait
    struct box box = nodes[below].box;
    include(&box, nodes[below + 1].box.lo, nodes[below + 1].box.hi);
    nodes[node] = (struct hierarchy_node){box, below, 0};
    if (count > LEAST_TASK) {
        const uint32_t done = (left > LEAST_TASK ? 0 : left) + (right > LEAST_TASK ? 0 : right);
#pragma omp critical(hierarchy_progress)
        progress_advance(&building->progress, done);
    }
}

enum status hierarchy_build(const struct PackedSphere *spheres, uint32_t first, uint32_t count,
                            struct hierarchy *hierarchy)
{
    *hierarchy = (struct hierarchy){.node_count = 2 * count - 1};
    struct leaf *leaves = malloc(count * sizeof *leaves);
    hierarchy->nodes = malloc(hierarchy->node_count * sizeof *hierarchy->nodes);
    if (!leaves || !hierarchy->nodes) {
        log_error("no memory for a hierarchy over %u spheres", count);
        free(leaves);
        hierarchy_destroy(hierarchy);
        return STATUS_UNABLE;
    }
    for (uint32_t i = 0; i < count; ++i) {
        const layout_vec4 sphere = spheres[first + i].center_radius;
        leaves[i] = (struct leaf){{sphere.x, sphere.y, sphere.z}, sphere.w, first + i};
    }
    struct building building = {.nodes = hierarchy->nodes};
    progress_start(&building.progress, "hierarchy", count, false);
#pragma omp parallel
#pragma omp single
    build(&building, 0, 1, leaves, count, 0);
    progress_end(&building.progress);
    free(leaves);
    return STATUS_DONE;
}

void hierarchy_destroy(struct hierarchy *hierarchy)
{
    free(hierarchy->nodes);
    sphere_tree_destroy(&hierarchy->tree);
    *hierarchy = (struct hierarchy){0};
}

static bool touch(const struct box *a, const struct box *b)
{
    bool touching = true;
    for (int i = 0; i < 3; ++i)
        touching = touching && a->lo[i] <= b->hi[i] && b->lo[i] <= a->hi[i];
    return touching;
}

static bool visit_below(const struct hierarchy *hierarchy, uint32_t place, const struct box *box,
                        hierarchy_visitor *visit, void *user)
{
    const struct hierarchy_node *node = &hierarchy->nodes[place];
    if (!touch(&node->box, box))
        return true;
    if (node->left == 0)
        return visit(user, node->sphere);
    return visit_below(hierarchy, node->left, box, visit, user) &&
           visit_below(hierarchy, node->left + 1, box, visit, user);
}

void hierarchy_visit(const struct hierarchy *hierarchy, struct box box, hierarchy_visitor *visit, void *user)
{
    if (hierarchy->node_count > 0)
        visit_below(hierarchy, 0, &box, visit, user);
}
