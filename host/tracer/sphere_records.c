#include "tracer/sphere_records.h"

#include <math.h>
#include <string.h>

#include "base/progress.h"
#include "scene/hierarchy.h"

/* Where a box is on the grid over all boxes. The grid begins so many steps below them that the upper ends,
 * which lie in the high half of a word, make a normal number of it: processors are slow with denormals, which
 * the shader would compute with where it takes boxes for spheres, and ignore. */
enum { STEPS_BELOW = 257, STEPS = 65200 };

enum { NODES_A_STEP = 16384 }; /* of the progress */

/* A box of the stream is worth its record if it is smaller than the box of the record above by this factor,
 * and around more than two spheres. Shadow rays of sphereflakes and clouds take least turns so, with a box
 * for each third sphere; with 0.75 and boxes around two they take up to a tenth more, with nine boxes for ten
 * spheres. */
static const float worth = 0.5F;

struct writing {
    const struct packed_scene *scene;
    const struct hierarchy_node *nodes;
    float origin[3], step[3];
    uint32_t (*records)[4]; /* NULL: only counting */
    uint32_t *words, *sphere_words;
    uint32_t next;             /* record of the stream */
    float worth;               /* that factor, or less where the stream has no room for so many boxes */
    struct progress *progress; /* in nodes, each of which is written twice */
};

static void lay_grid(struct writing *writing, const struct box *box)
{
    for (int a = 0; a < 3; ++a) {
        float step = (float)(((double)box->hi[a] - (double)box->lo[a]) / (double)STEPS);
        writing->step[a] = nextafterf(fmaxf(step, 0x1p-100F), INFINITY);
        writing->origin[a] = (float)((double)box->lo[a] - (double)STEPS_BELOW * (double)writing->step[a]);
    }
}

/* The grid's plane next to the coordinate, on the side away from the box. */
static uint32_t grid_plane(const struct writing *writing, int axis, float coordinate, bool upper)
{
    const double origin = (double)writing->origin[axis], step = (double)writing->step[axis];
    double plane = ((double)coordinate - origin) / step;
    plane = upper ? ceil(plane) : floor(plane);
    if (upper ? origin + plane * step < (double)coordinate : origin + plane * step > (double)coordinate)
        plane += upper ? 1 : -1;
    return (uint32_t)plane;
}

static void write_box(const struct writing *writing, uint32_t record, const struct box *box, uint32_t link)
{
    uint32_t *words = writing->records[record];
    for (int a = 0; a < 3; ++a)
        words[a] = grid_plane(writing, a, box->lo[a], false) | grid_plane(writing, a, box->hi[a], true) << 16;
    words[3] = BOX_FLAG | link;
}

/* Writes the sphere of a leaf; `which` place of its is the record. */
static void write_sphere(const struct writing *writing, uint32_t record, const struct hierarchy_node *leaf,
                         int which)
{
    const struct packed_scene *scene = writing->scene;
    const struct PackedSphere *sphere = &scene->spheres[leaf->sphere];
    const uint32_t number = leaf->sphere - (uint32_t)scene->looped_spheres;
    memcpy(writing->records[record], &sphere->center_radius, sizeof *writing->records);
    writing->words[record] = number | (sphere->tags.HOLDS_RAYS ? HOLDS_RAYS_FLAG : 0) |
                             (sphere->tags.HOLDS_LIGHTS ? HOLDS_LIGHTS_FLAG : 0);
    uint32_t *words = writing->sphere_words + (size_t)SPHERE_WORDS * number;
    words[which] = record;
    words[SPHERE_SURFACE] = (uint32_t)sphere->tags.SURFACE;
}

/* A record that is no box, and a sphere that is never met. */
static void write_nothing(const struct writing *writing, uint32_t record)
{
    memcpy(writing->records[record], &(layout_vec4){.w = 0}, sizeof *writing->records);
}

/* Each node but the root has its record in the place of its number: children lie side by side. */
static uint32_t record_of(uint32_t node)
{
    return HEAD_RECORDS + node - 1;
}

static void write_pairs(const struct writing *writing, struct progress *progress)
{
    const struct hierarchy *hierarchy = writing->scene->hierarchy;
    if (hierarchy->node_count == 1) {
        write_sphere(writing, HEAD_RECORDS, hierarchy->nodes, PLACE_IN_PAIRS);
        write_nothing(writing, HEAD_RECORDS + 1);
    }
#pragma omp parallel for schedule(dynamic) if (hierarchy->node_count > NODES_A_STEP)
    for (uint32_t first = 1; first < hierarchy->node_count; first += NODES_A_STEP) {
        for (uint32_t i = first; i < hierarchy->node_count && i < first + NODES_A_STEP; ++i) {
            const struct hierarchy_node *node = &hierarchy->nodes[i];
            if (node->left == 0)
                write_sphere(writing, record_of(i), node, PLACE_IN_PAIRS);
            else
                write_box(writing, record_of(i), &node->box, record_of(node->left));
        }
#pragma omp critical(records_progress)
        progress_advance(progress, NODES_A_STEP);
    }
}

/* Writes the subtree as it comes depth first, the larger child before the smaller one: what blocks a light is
 * found sooner. above: the half area of the box around. */
static void write_stream(struct writing *writing, uint32_t place, float above)
{
    const struct hierarchy_node *node = &writing->nodes[place];
    const uint32_t record = writing->next;
    if (node->left == 0) {
        if (writing->records)
            write_sphere(writing, record, node, PLACE_IN_STREAM);
        if (writing->records && node->sphere % NODES_A_STEP == 0)
            progress_advance(writing->progress, 2 * NODES_A_STEP);
        ++writing->next;
        return;
    }
    const struct hierarchy_node *left = &writing->nodes[node->left], *right = left + 1;
    const float area = box_half_area(&node->box);
    const bool kept = area < writing->worth * above && (left->left > 0 || right->left > 0);
    const bool turned = box_half_area(&left->box) < box_half_area(&right->box);
    writing->next += kept;
    write_stream(writing, node->left + turned, kept ? area : above);
    write_stream(writing, node->left + !turned, kept ? area : above);
    if (kept && writing->records)
        write_box(writing, record, &node->box, writing->next);
}

/* Where the stream will end that is about to be written. */
static uint32_t stream_end(const struct writing *writing)
{
    struct writing counting = *writing;
    counting.records = NULL;
    write_stream(&counting, 0, INFINITY);
    return counting.next;
}

static uint64_t other_count(const struct packed_scene *scene)
{
    return (uint64_t)(scene->sphere_count - scene->looped_spheres);
}

/* At least a pair. */
static uint64_t pair_records(const struct packed_scene *scene)
{
    const uint64_t count = other_count(scene);
    return count == 0 ? 0 : count == 1 ? 2 : 2 * count - 2;
}

uint64_t sphere_record_count(const struct packed_scene *scene)
{
    const uint64_t count = other_count(scene);
    return HEAD_RECORDS + pair_records(scene) + count + 3 * count / 8;
}

uint64_t sphere_word_count(const struct packed_scene *scene)
{
    return sphere_record_count(scene) + SPHERE_WORDS * other_count(scene);
}

void sphere_records_write(const struct packed_scene *scene, uint32_t (*records)[4], uint32_t *words)
{
    const uint32_t stream = HEAD_RECORDS + (uint32_t)pair_records(scene);
    struct progress progress;
    struct writing writing = {
        .scene = scene,
        .records = records,
        .words = words,
        .next = stream,
        .worth = worth,
        .progress = &progress,
    };
    float largest = 0;
    progress_start(&progress, "boxes for the device", 4 * other_count(scene), false);
    if (scene->hierarchy) {
        writing.nodes = scene->hierarchy->nodes;
        uint32_t end;
        while ((end = stream_end(&writing)) > sphere_record_count(scene))
            writing.worth *= 0.75F;
        writing.sphere_words = words + end;
        const struct box *box = &writing.nodes->box;
        for (int a = 0; a < 3; ++a)
            largest = fmaxf(largest, fmaxf(-box->lo[a], box->hi[a]));
        lay_grid(&writing, box);
        write_pairs(&writing, &progress);
        write_stream(&writing, 0, INFINITY);
    }
    const layout_vec4 origin = {writing.origin[0], writing.origin[1], writing.origin[2], largest};
    const layout_vec4 step = {writing.step[0], writing.step[1], writing.step[2], 0};
    memcpy(records[GRID_ORIGIN], &origin, sizeof origin);
    memcpy(records[GRID_STEP], &step, sizeof step);
    records[STREAM][0] = stream;
    records[STREAM][1] = writing.next;
    progress_end(&progress);
}
