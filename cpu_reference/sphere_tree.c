#include "sphere_tree.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

enum { SPHERES_A_LEAF = 4, SPHERES_A_TASK = 4096 };

struct ball {
    float center[3], radius; /* rounded up */
};

/* All leaves are equally deep. Node 1 is the root, the children of i are 2 i and 2 i + 1; node k of those at
 * depth d has the places count k / 2^d to count (k + 1) / 2^d, rounded down, of the order. */
struct sphere_tree {
    uint32_t count;
    int depth;          /* of the leaves */
    struct ball *nodes; /* around all of their spheres */
    int *order;         /* numbers of spheres */
};

/* What building sorts. */
struct item {
    float center[3], radius;
    int sphere;
};

struct node {
    uint32_t number;
    int depth;
};

static struct tree_vector to_vector(const float *v)
{
    return (struct tree_vector){(double)v[0], (double)v[1], (double)v[2]};
}

static struct tree_vector minus(struct tree_vector a, struct tree_vector b)
{
    return (struct tree_vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double product(struct tree_vector a, struct tree_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double size_of(struct tree_vector v)
{
    return sqrt(product(v, v));
}

static uint32_t first_place(const struct sphere_tree *tree, struct node node)
{
    uint32_t k = node.number - (UINT32_C(1) << node.depth);
    return (uint32_t)((uint64_t)tree->count * k >> node.depth);
}

static uint32_t end_place(const struct sphere_tree *tree, struct node node)
{
    return first_place(tree, (struct node){node.number + 1, node.depth});
}

static struct node child(struct node parent, unsigned which)
{
    return (struct node){2 * parent.number + which, parent.depth + 1};
}

/* Hoare's FIND (CACM 4(7), 1961): items before the middle one get coordinates no larger than its, those
 * behind none smaller. Equal ones are shared out among both sides. */
static void find_middle(struct item *items, ptrdiff_t count, ptrdiff_t middle, int axis)
{
    ptrdiff_t left = 0, right = count - 1;
    uint64_t random = 1;
    while (left < right) {
        random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        float pivot = items[left + (ptrdiff_t)(random >> 33) % (right - left + 1)].center[axis];
        ptrdiff_t i = left, j = right;
        while (i <= j) {
            while (items[i].center[axis] < pivot)
                ++i;
            while (pivot < items[j].center[axis])
                --j;
            if (i > j)
                break;
            struct item swapped = items[i];
            items[i++] = items[j];
            items[j--] = swapped;
        }
        if (middle <= j)
            right = j;
        else if (middle >= i)
            left = i;
        else
            return;
    }
}

/* Around all of the spheres, about any centre. */
static struct ball ball_about(struct tree_vector middle, const struct item *items, size_t count)
{
    struct ball ball = {.center = {(float)middle.x, (float)middle.y, (float)middle.z}};
    struct tree_vector center = to_vector(ball.center);
    double radius = 0;
    for (size_t i = 0; i < count; ++i) {
        double reach = size_of(minus(to_vector(items[i].center), center)) + (double)items[i].radius;
        radius = reach > radius ? reach : radius;
    }
    ball.radius = nextafterf((float)radius, INFINITY);
    return ball;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* About the middle of the box around the spheres. *axis gets the longest of the box around their centres. */
static struct ball ball_around(const struct item *items, size_t count, int *axis)
{
    /* of both boxes the upper sides, and the lower ones times -1 */
    double most[3], least[3], high[3], low[3], middle[3], longest = -1;
    for (int a = 0; a < 3; ++a) {
        most[a] = least[a] = high[a] = low[a] = -INFINITY;
        for (size_t i = 0; i < count; ++i) {
            double center = (double)items[i].center[a], radius = (double)items[i].radius;
            most[a] = larger(most[a], center);
            least[a] = larger(least[a], -center);
            high[a] = larger(high[a], center + radius);
            low[a] = larger(low[a], radius - center);
        }
        middle[a] = (high[a] - low[a]) / 2;
        if (most[a] + least[a] > longest) {
            longest = most[a] + least[a];
            *axis = a;
        }
    }
    return ball_about((struct tree_vector){middle[0], middle[1], middle[2]}, items, count);
}

struct building {
    struct sphere_tree *tree;
    struct item *items;
    tree_progress *progress;
    void *user;
};

static void build(const struct building *building, struct node node)
{
    struct sphere_tree *tree = building->tree;
    struct item *items = building->items;
    const uint32_t first = first_place(tree, node), end = end_place(tree, node);
    int axis = 0;
    tree->nodes[node.number] = ball_around(items + first, end - first, &axis);
    if (node.depth == tree->depth) {
        for (uint32_t i = first; i < end; ++i)
            tree->order[i] = items[i].sphere;
        return;
    }
    const struct node left = child(node, 0), right = child(node, 1);
    find_middle(items + first, end - first, end_place(tree, left) - first, axis);
#pragma omp task if (end - first > SPHERES_A_TASK)
    build(building, left);
    build(building, right);
    if (building->progress && end - first <= SPHERES_A_TASK && 2 * (end - first) > SPHERES_A_TASK) {
#pragma omp critical(tree_progress)
        building->progress(building->user, end - first);
    }
}

static struct item *copy_items(const struct PackedSphere *spheres, int first, int end)
{
    struct item *items = malloc((size_t)(end - first) * sizeof *items);
    for (int i = first; items && i < end; ++i) {
        layout_vec4 shape = spheres[i].center_radius;
        items[i - first] = (struct item){{shape.x, shape.y, shape.z}, shape.w, i};
    }
    return items;
}

struct sphere_tree *sphere_tree_create(const struct PackedSphere *spheres, int first, int end, int threads,
                                       tree_progress *progress, void *user)
{
    struct sphere_tree *tree = calloc(1, sizeof *tree);
    struct item *items = copy_items(spheres, first, end);
    if (tree) {
        tree->count = (uint32_t)(end - first);
        while (tree->count > (uint64_t)SPHERES_A_LEAF << tree->depth)
            ++tree->depth;
        tree->nodes = calloc((size_t)2 << tree->depth, sizeof *tree->nodes);
        tree->order = calloc(tree->count, sizeof *tree->order);
    }
    if (tree && items && tree->nodes && tree->order) {
        const struct building building = {tree, items, progress, user};
#pragma omp parallel num_threads(threads)
#pragma omp single
        build(&building, (struct node){1, 0});
    } else {
        sphere_tree_destroy(&tree);
    }
    free(items);
    return tree;
}

void sphere_tree_destroy(struct sphere_tree **tree)
{
    if (*tree) {
        free((*tree)->nodes);
        free((*tree)->order);
        free(*tree);
    }
    *tree = NULL;
}

/* NUMERICS.md, "Many spheres: the reference's tree", derives these: the unit roundoffs of (distance + radius)
 * that the distance of a line from a centre loses, and how many of those losses a distance along it does. */
static const double line_roundings = 3, along_multiple = 3;
static const double own_unit = 0x1p-51;  /* what is lost here, in double */
static const double underflow = 0x1p-73; /* squares of less are not float's */

/* Whether a sphere in the ball may hold the segment's end. */
static bool may_hold_end(const struct tree_line *line, const struct ball *ball)
{
    double apart = size_of(minus(to_vector(ball->center), line->end)), radius = (double)ball->radius;
    double slack = line->e_end + line_roundings * (line->unit + own_unit) * (apart + radius);
    return line->has_end && !(apart > radius + slack + underflow);
}

/* Whether the line may meet a sphere in the ball at a distance up to the limit; where it may, *entry is at
 * most that. What is not a number may. */
static bool may_meet(const struct sphere_walk *walk, uint32_t node, double *entry)
{
    const struct tree_line *line = &walk->line;
    const struct ball *ball = &walk->tree->nodes[node];
    struct tree_vector to_center = minus(to_vector(ball->center), line->origin), direction = line->direction;
    double radius = (double)ball->radius;
    double along = product(to_center, direction);
    double closest = along * walk->inverse_squared;
    struct tree_vector aside = {to_center.x - closest * direction.x, to_center.y - closest * direction.y,
                                to_center.z - closest * direction.z};
    double slack =
        line->e_origin + underflow +
        (size_of(to_center) + radius) * (line->e_direction + line_roundings * (line->unit + own_unit));
    double reach = radius * walk->stretch + along_multiple * slack;
    double beside = radius + slack;
    *entry = along - reach;
    if (!(*entry > walk->limit || along + reach < 0 || product(aside, aside) > beside * beside))
        return true;
    *entry = *entry > walk->limit ? walk->limit : *entry;
    return may_hold_end(line, ball);
}

static void push(struct sphere_walk *walk, uint32_t node, double entry)
{
    walk->stack[walk->depth].node = node;
    walk->stack[walk->depth++].entry = entry;
}

struct sphere_walk sphere_walk_begin(const struct sphere_tree *tree, const struct tree_line *line,
                                     double limit)
{
    double squared = product(line->direction, line->direction), entry;
    struct sphere_walk walk;
    walk.tree = tree;
    walk.line = *line;
    walk.limit = limit > 0 ? limit : 0; /* a ray that starts in a sphere meets it, no matter how */
    walk.stretch = squared > 1 ? sqrt(squared) : 1;
    walk.inverse_squared = 1 / squared;
    walk.depth = 0;
    walk.next = walk.last = 0;
    if (may_meet(&walk, 1, &entry))
        push(&walk, 1, entry);
    return walk;
}

/* To the next leaf that may have something. */
static bool find_leaf(struct sphere_walk *walk)
{
    const struct sphere_tree *tree = walk->tree;
    while (walk->depth > 0) {
        uint32_t node = walk->stack[--walk->depth].node;
        if (walk->stack[walk->depth].entry > walk->limit)
            continue;
        if (node >> tree->depth == 1) {
            walk->next = first_place(tree, (struct node){node, tree->depth});
            walk->last = end_place(tree, (struct node){node, tree->depth});
            return true;
        }
        double entries[2];
        const bool met[2] = {may_meet(walk, 2 * node, &entries[0]),
                             may_meet(walk, 2 * node + 1, &entries[1])};
        const uint32_t farther = entries[0] < entries[1];
        if (met[farther])
            push(walk, 2 * node + farther, entries[farther]);
        if (met[1 - farther])
            push(walk, 2 * node + 1 - farther, entries[1 - farther]);
    }
    return false;
}

int sphere_walk_next(struct sphere_walk *walk)
{
    if (walk->next == walk->last && !find_leaf(walk))
        return NO_MORE_SPHERES;
    return walk->tree->order[walk->next++];
}
