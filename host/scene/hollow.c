#include "scene/hollow.h"

#include "base/progress.h"
#include "scene/body.h"

enum {
    LEAST_PARALLEL = 4096, /* spheres or nodes for which other threads pay */
    NODES_A_PART = 1024
};

/* A body whose surface is looked for in a sphere. */
struct search {
    const struct packed_scene *packed;
    struct body holder;
    int sphere; /* its number */
    bool found;
};

static bool look_at(void *user, uint32_t body)
{
    struct search *search = user;
    const int i = (int)body;
    search->found = i != search->sphere && body_reaches_into(body_packed(search->packed, i), search->holder);
    return !search->found;
}

/* Whether some point of a light may lie within the sphere; for quads, of the ball around them. */
static bool holds_lights(const struct packed_scene *packed, int sphere)
{
    const struct body holder = body_packed(packed, sphere);
    bool holds = false;
    for (int i = 0; i < packed->point_light_count; ++i)
        holds |= body_distance(holder, dvec3_of_vec4(packed->point_lights[i].position)) < 0;
    for (int i = 0; i < packed->quad_light_count; ++i) {
        const struct PackedQuadLight *quad = &packed->quad_lights[i];
        struct dvec3 u = dvec3_of_vec4(quad->edge_u), v = dvec3_of_vec4(quad->edge_v);
        struct dvec3 middle = dvec3_add(dvec3_of_vec4(quad->corner), dvec3_scale(0.5, dvec3_add(u, v)));
        holds |= body_distance(holder, middle) < (dvec3_length(u) + dvec3_length(v)) / 2;
    }
    return holds;
}

static void look_inside(struct packed_scene *packed, int sphere)
{
    struct search search = {.packed = packed, .holder = body_packed(packed, sphere), .sphere = sphere};
    if (body_surface(packed, sphere)->tags.SURFACE_KIND == KIND_TRANSPARENT)
        body_visit(packed, body_box(search.holder), look_at, &search);
    if (search.found)
        packed->spheres[sphere].tags.HOLDS_RAYS = 1;
}

static void look_inside_others(struct packed_scene *packed)
{
    const struct hierarchy *others = packed->hierarchy;
    struct progress progress;
    progress_start(&progress, "looking into glass", others->node_count, false);
#pragma omp parallel for schedule(dynamic) if (others->node_count > LEAST_PARALLEL)
    for (uint32_t first = 0; first < others->node_count; first += NODES_A_PART) {
        for (uint32_t i = first; i < others->node_count && i < first + NODES_A_PART; ++i)
            if (others->nodes[i].left == 0)
                look_inside(packed, (int)others->nodes[i].sphere);
#pragma omp critical(hollow_progress)
        progress_advance(&progress, NODES_A_PART);
    }
    progress_end(&progress);
}

/* A ray or a shading point can lie within a sphere other than on it if the camera is in it, or if it is
 * transparent and another surface reaches in. That is asked in the order of the hierarchy, so that spheres
 * one after the other look at the same of its nodes. */
void hollow_pack(struct packed_scene *packed)
{
    const struct dvec3 camera = dvec3_of_vec4(packed->view.position);
#pragma omp parallel for if (packed->sphere_count > LEAST_PARALLEL)
    for (int i = 0; i < packed->sphere_count; ++i) {
        packed->spheres[i].tags.HOLDS_RAYS = body_distance(body_packed(packed, i), camera) < 0;
        packed->spheres[i].tags.HOLDS_LIGHTS = holds_lights(packed, i);
    }
    for (int i = 0; i < packed->looped_spheres; ++i)
        look_inside(packed, i);
    bool glass = false;
    for (int i = packed->looped_spheres; i < packed->surface_count; ++i)
        glass |= packed->surfaces[i].tags.SURFACE_KIND == KIND_TRANSPARENT;
    if (glass)
        look_inside_others(packed);
}
