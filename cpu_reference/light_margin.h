/* Running error analysis of direct light; see margin.h. */
#ifndef REFERENCE_LIGHT_MARGIN_H
#define REFERENCE_LIGHT_MARGIN_H

#include "margin.h"
#include "matte.h"

/* A number with what float may be off by. */
struct tracked {
    double value, error;
};

/* Margin of one sphere's blocking the segment or not; *blocks gets which. */
static inline double sphere_block_margin(const struct PackedSphere *sphere, int surface,
                                         const struct segment *segment, double e_from, double e_direction,
                                         bool *blocks)
{
    bool own = segment->surface == surface;
    *blocks = sphere_blocks(sphere, surface, segment);
    if (own && !segment->inward)
        return INFINITY;
    double margin = INFINITY;
    bool inside = own;
    if (sphere->tags.HOLDS_LIGHTS != 0) {
        margin = inside_margin(sphere->center_radius, segment->to, rounding(length(segment->to)));
        inside = inside || contains(sphere, segment->to);
    }
    if (!own && sphere->tags.HOLDS_RAYS != 0) {
        margin = smaller(margin, inside_margin(sphere->center_radius, segment->from, e_from));
        inside = inside || contains(sphere, segment->from);
    }
    if (inside)
        return margin; /* where the ends lie decides all */
    struct tracked_approach approach = track_approach(
        sphere->center_radius, segment->from, segment->direction, (struct ray_error){e_from, e_direction});
    struct conjunction blocked = conjunction_begin();
    require_positive(&blocked, approach.along, approach.e_along);
    require_positive(&blocked, approach.clearance, approach.e_clearance);
    require_positive(&blocked, (double)segment->length - approach.along, approach.e_along + e_from);
    return smaller(margin, conjunction_margin(&blocked));
}

/* Of a giant. */
static inline double giant_block_margin(const struct packed_scene *scene, int i,
                                        const struct segment *segment, double e_from, double e_direction,
                                        bool *blocks)
{
    const layout_ivec4 tags = scene->spheres[i].tags;
    const bool own = segment->surface == i;
    *blocks = tried_sphere_blocks(scene, i, segment);
    if (own && !segment->inward)
        return INFINITY;
    struct giant giant = giant_of(scene, i);
    struct tracked_giant_line line =
        track_giant_line(&giant, segment->from, segment->direction, (struct ray_error){e_from, e_direction},
                         !own && tags.HOLDS_RAYS != 0);
    double margin = INFINITY;
    bool inside = own || line.height < 0;
    if (tags.HOLDS_LIGHTS != 0) {
        double height = (double)giant_height(&giant, segment->to);
        margin = fabs(height) / height_error(&giant, segment->to, rounding(length(segment->to)));
        inside = inside || height < 0;
    }
    if (!own && tags.HOLDS_RAYS != 0)
        margin = smaller(margin, fabs(line.height) / line.e_height);
    if (inside)
        return margin; /* where the ends lie decides all */
    double bend = (double)giant.curvature * (double)segment->length;
    struct conjunction blocked = conjunction_begin();
    require_positive(&blocked, -line.slope, line.e_slope);
    require_positive(&blocked, line.root_squared, line.e_root_squared);
    require_positive(&blocked, bend + line.slope,
                     line.e_slope + (double)giant.curvature * e_from + rounding(bend));
    return smaller(margin, conjunction_margin(&blocked));
}

static inline double plane_block_margin(const struct PackedPlane *plane, int surface,
                                        const struct segment *segment, double e_from, bool *blocks)
{
    *blocks = plane_blocks(plane, surface, segment);
    if (plane->surface.tags.CASTS_SHADOWS == 0)
        return INFINITY;
    struct vec3 normal = vector_of(plane->normal_offset);
    double offset = (double)plane->normal_offset.w;
    double end = fabs((double)dot(normal, segment->to) - offset);
    double margin = end / rounding(length(segment->to) + fabs(offset));
    if (plane->surface.tags.SURFACE_KIND != KIND_TRANSPARENT || segment->surface == surface)
        return margin;
    double start = fabs((double)dot(normal, segment->from) - offset);
    return smaller(margin, start / (e_from + rounding(length(segment->from) + fabs(offset))));
}

/* Whether a point is hidden, and how safe that is. */
struct shadow {
    bool hides;
    double weakest;         /* margin of what does not block */
    double strongest_block; /* of what does */
};

static inline void add_blocker(struct shadow *shadow, bool blocks, double margin)
{
    shadow->hides = shadow->hides || blocks;
    if (blocks)
        shadow->strongest_block = larger(shadow->strongest_block, margin);
    else
        shadow->weakest = smaller(shadow->weakest, margin);
}

static inline void add_sphere(const struct packed_scene *scene, int i, const struct segment *segment,
                              double e_from, double e_direction, struct shadow *shadow)
{
    bool blocks;
    double margin = is_giant(scene, i)
                        ? giant_block_margin(scene, i, segment, e_from, e_direction, &blocks)
                        : sphere_block_margin(&scene->spheres[i], i, segment, e_from, e_direction, &blocks);
    add_blocker(shadow, blocks, margin);
}

/* As tree_line_in_float(). */
static inline struct tree_line tree_segment_in_float(const struct segment *segment, double e_from,
                                                     double e_direction, double wanted)
{
    struct tree_line line = tree_line_in_float(segment->from, segment->direction,
                                               (struct ray_error){e_from, e_direction}, wanted);
    line.has_end = true;
    line.end = to_tree_vector(segment->to);
    line.e_end = tree_rounding(segment->to) + wanted * rounding(length(segment->to));
    return line;
}

/* Those that the tree does not rule out, which looks ever closer as smaller margins are found. */
static inline void add_tree_spheres(const struct packed_scene *scene, const struct segment *segment,
                                    double e_from, double e_direction, double wanted, struct shadow *shadow)
{
    if (is_in_tree(scene, segment->surface))
        add_sphere(scene, segment->surface, segment, e_from, e_direction, shadow);
    wanted = smaller(shadow->weakest, wanted);
    const struct tree_line line = tree_segment_in_float(segment, e_from, e_direction, wanted);
    struct sphere_walk walk = sphere_walk_begin(scene->tree, &line, (double)segment->length);
    for (int i; (i = sphere_walk_next(&walk)) != NO_MORE_SPHERES;) {
        add_sphere(scene, i, segment, e_from, e_direction, shadow);
        if (shadow->weakest < wanted) {
            wanted = shadow->weakest;
            walk.line = tree_segment_in_float(segment, e_from, e_direction, wanted);
        }
    }
}

/* Margin of the light point's being hidden; *hides gets whether it is. Where it is not and the margin is at
 * least `wanted`, which is at most 1, any such number. */
static inline double shadow_margin(const struct packed_scene *scene, const struct segment *segment,
                                   double e_from, double e_direction, double wanted, bool *hides)
{
    struct shadow shadow = {.weakest = INFINITY};
    for (int i = 0; i < tried_spheres(scene); ++i)
        add_sphere(scene, i, segment, e_from, e_direction, &shadow);
    if (scene->tree)
        add_tree_spheres(scene, segment, e_from, e_direction, wanted, &shadow);
    for (int i = 0; i < scene->plane_count; ++i) {
        bool blocks;
        double margin =
            plane_block_margin(&scene->planes[i], scene->sphere_count + i, segment, e_from, &blocks);
        add_blocker(&shadow, blocks, margin);
    }
    *hides = shadow.hides;
    return shadow.hides ? shadow.strongest_block : shadow.weakest;
}

/* As receive(), with its error, for a point light (quad NULL) or a point of a quad; *margin is lowered to
 * that of its being lit or not. */
static inline struct tracked track_receive(const struct packed_scene *scene, const struct matte_point *matte,
                                           struct hit_error hit_error, double e_ray_direction,
                                           const struct PackedQuadLight *quad, struct vec3 light,
                                           double e_light, struct vec3 *to_light, struct tally *tally,
                                           double *e_to_light, double *margin)
{
    const struct hit *hit = matte->hit;
    double value = (double)receive(scene, matte, light, to_light, tally);
    double distance = length(subtract(light, hit->point));
    double e_way = hit_error.point + e_light + rounding(distance);
    *e_to_light = e_way / distance + rounding(1);
    if (!(distance * distance > NEAREST_LIGHT_SQUARED))
        return (struct tracked){value, 0};
    struct vec3 direction = scale(1 / (real)distance, subtract(light, hit->point));
    double cos_in = (double)dot(hit->normal, direction), cos_out = fabs((double)matte->cos_out);
    double e_cos_in = *e_to_light + hit_error.normal + rounding(1);
    double e_cos_out = e_ray_direction + hit_error.normal + rounding(1);
    NOTE_LIGHT_BOUNDS(e_light, e_way, e_cos_in, 0, INFINITY);
    if (cos_in < -e_cos_in)
        return (struct tracked){value, 0};

    /* The factor (a + b s / larger) cos_in is continuous, so neither s > 0 nor cos_in > 0 is a decision. */
    double a = (double)hit->material->parameters.OREN_NAYAR_A,
           b = (double)hit->material->more_parameters.OREN_NAYAR_B;
    double s = larger(-(double)dot(direction, matte->ray->direction) - cos_in * cos_out, 0);
    double larger_cos = larger(larger(cos_in, cos_out), e_cos_in);
    double e_s = *e_to_light + e_ray_direction + cos_out * e_cos_in + cos_in * e_cos_out + rounding(1);
    double in = larger(cos_in, 0);
    double ratio = s / larger_cos;
    double factor = (a + b * ratio) * in;
    double e_factor = (a + b * ratio) * e_cos_in +
                      b * smaller(1, (in + e_cos_in) / larger_cos) * (e_s + ratio * (e_cos_in + e_cos_out)) +
                      rounding(2 * factor);
    double falloff = 1 / (distance * distance);
    double error = (e_factor + factor * (2 * e_way / distance + rounding(2))) * falloff;
    struct segment segment = {hit->point, light, direction, (real)distance, hit->surface, hit->from_inside};
    struct conjunction lit = conjunction_begin();
    bool hides = false;
    double shadow = 0;
    if (*margin != 0 || RECORDS) /* it cannot fall below */
        shadow = shadow_margin(scene, &segment, hit_error.point, *e_to_light,
                               RECORDS ? 1 : smaller(*margin, 1), &hides);
    require_positive(&lit, cos_in, e_cos_in);
    require_positive(&lit, hides ? -shadow : shadow, 1);
    if (quad) {
        double area = length(vector_of(quad->area_normal));
        require_positive(&lit, (double)dot(vector_of(quad->area_normal), direction),
                         area * (*e_to_light + rounding(1)));
    }
    *margin = smaller(*margin, conjunction_margin(&lit));
    NOTE_LIGHT_BOUNDS(e_light, e_way, e_cos_in, error, conjunction_margin(&lit));
    return (struct tracked){value, error};
}

/* Error of reflect_lights() without albedo, for each channel; runs through the same points in the same order.
 */
static inline struct vec3 track_lights(const struct packed_scene *scene, const struct ray *ray,
                                       const struct hit *hit, struct hit_error hit_error,
                                       double e_ray_direction, uint32_t seed, uint32_t pixel_sample,
                                       struct vec3 *sum_of_errors, struct tally *tally, double *margin)
{
    struct matte_point matte = {ray, hit, -dot(hit->normal, ray->direction)};
    struct vec3 sum = {0, 0, 0}, errors = {0, 0, 0};
    struct vec3 to_light = {0, 0, 0};
    double e_to_light;
    for (int i = 0; i < scene->point_light_count; ++i) {
        struct vec3 position = vector_of(scene->point_lights[i].position);
        struct tracked received = track_receive(scene, &matte, hit_error, e_ray_direction, NULL, position, 0,
                                                &to_light, tally, &e_to_light, margin);
        note(tally, received.value > 0);
        RECORD_LIGHT(i, 0, position, 1);
        struct vec3 intensity = vector_of(scene->point_lights[i].intensity);
        sum = add(sum, scale((real)received.value, intensity));
        errors = add(errors, scale((real)(received.error + rounding(received.value)), intensity));
    }
    for (int i = 0; i < scene->quad_light_count; ++i) {
        const struct PackedQuadLight *quad = &scene->quad_lights[i];
        struct vec3 edge_u = vector_of(quad->edge_u), edge_v = vector_of(quad->edge_v);
        double area = length(vector_of(quad->area_normal));
        double quad_sum = 0, quad_error = 0;
        for (int k = 0; k < scene->light_samples; ++k) {
            real u, v;
            sobol_point(seed + (uint32_t)i, pixel_sample * (uint32_t)scene->light_samples + (uint32_t)k, &u,
                        &v);
            struct vec3 light = add(add(vector_of(quad->corner), scale(u, edge_u)), scale(v, edge_v));
            double e_light = rounding(length(light) + length(edge_u) + length(edge_v));
            struct tracked received = track_receive(scene, &matte, hit_error, e_ray_direction, quad, light,
                                                    e_light, &to_light, tally, &e_to_light, margin);
            double projected = (double)dot(vector_of(quad->area_normal), to_light);
            bool lit = received.value > 0 && projected > 0;
            note(tally, lit);
            double e_projected = area * (e_to_light + rounding(1));
            NOTE_AREA_BOUND(e_projected);
            RECORD_LIGHT(scene->point_light_count + i, k, light, (real)projected);
            quad_sum += lit ? received.value * projected : 0;
            quad_error += received.error * larger(projected, 0) + received.value * e_projected;
        }
        quad_error += scene->light_samples * unit_roundoff * quad_sum; /* the plain sum's */
        sum = add(sum, scale((real)quad_sum, vector_of(quad->radiance)));
        errors = add(errors, scale((real)(quad_error + rounding(quad_sum)), vector_of(quad->radiance)));
    }
    *sum_of_errors = errors;
    return sum;
}

#endif
