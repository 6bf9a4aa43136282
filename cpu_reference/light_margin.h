/* Running error analysis of direct light; see margin.h. */
#ifndef REFERENCE_LIGHT_MARGIN_H
#define REFERENCE_LIGHT_MARGIN_H

#include "margin.h"
#include "matte.h"

/* Margin of sphere i's blocking the segment or not; *blocks gets which. */
static inline double sphere_block_margin(const struct packed_scene *scene, int i,
                                         const struct segment *segment, struct ray_error error, bool *blocks)
{
    const layout_ivec4 tags = scene->spheres[i].tags;
    const bool own = segment->surface == i;
    *blocks = sphere_blocks(scene, i, segment);
    if (own && !segment->inward)
        return INFINITY;
    double margin = INFINITY;
    bool inside = own;
    if (tags.HOLDS_LIGHTS != 0) {
        margin = inside_margin(scene, i, segment->to, rounding(length(segment->to)));
        inside = inside || lies_inside(scene, i, segment->to);
    }
    if (!own && tags.HOLDS_RAYS != 0) {
        margin = smaller(margin, inside_margin(scene, i, segment->from, error.origin));
        inside = inside || lies_inside(scene, i, segment->from);
    }
    if (inside)
        return margin; /* where the ends lie decides all */
    struct conjunction blocked = conjunction_begin();
    if (is_giant(scene, i)) {
        struct giant giant = giant_of(scene, i);
        struct tracked_giant_line line =
            track_giant_line(&giant, segment->from, segment->direction, error, tags.HOLDS_RAYS != 0);
        double bend = (double)giant.curvature * (double)segment->length;
        require_positive(&blocked, -line.slope, line.e_slope);
        require_positive(&blocked, line.root_squared, line.e_root_squared);
        require_positive(&blocked, bend + line.slope,
                         line.e_slope + (double)giant.curvature * error.origin + rounding(bend));
    } else {
        struct tracked_approach approach =
            track_approach(scene->spheres[i].center_radius, segment->from, segment->direction, error);
        require_positive(&blocked, approach.along, approach.e_along);
        require_positive(&blocked, approach.clearance, approach.e_clearance);
        require_positive(&blocked, (double)segment->length - approach.along, approach.e_along + error.origin);
    }
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
    double margin =
        margin_of((double)dot(normal, segment->to) - offset, rounding(length(segment->to) + fabs(offset)));
    if (plane->surface.tags.SURFACE_KIND != KIND_TRANSPARENT || segment->surface == surface)
        return margin;
    return smaller(margin, margin_of((double)dot(normal, segment->from) - offset,
                                     e_from + rounding(length(segment->from) + fabs(offset))));
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
                              struct ray_error error, struct shadow *shadow)
{
    bool blocks;
    double margin = sphere_block_margin(scene, i, segment, error, &blocks);
    add_blocker(shadow, blocks, margin);
}

/* As tree_line_in_float(). */
static inline struct tree_line tree_segment_in_float(const struct segment *segment, struct ray_error error,
                                                     double wanted)
{
    struct tree_line line = tree_line_in_float(segment->from, segment->direction, error, wanted);
    line.has_end = true;
    line.end = to_tree_vector(segment->to);
    line.e_end = tree_rounding(segment->to) + wanted * rounding(length(segment->to));
    return line;
}

/* Those that the tree does not rule out, which looks ever closer as smaller margins are found. */
static inline void add_tree_spheres(const struct packed_scene *scene, const struct segment *segment,
                                    struct ray_error error, struct shadow *shadow)
{
    if (is_in_tree(scene, segment->surface))
        add_sphere(scene, segment->surface, segment, error, shadow);
    double wanted = smaller(shadow->weakest, 1);
    const struct tree_line line = tree_segment_in_float(segment, error, wanted);
    struct sphere_walk walk = sphere_walk_begin(scene->tree, &line, (double)segment->length);
    for (int i; (i = sphere_walk_next(&walk)) != NO_MORE_SPHERES;) {
        add_sphere(scene, i, segment, error, shadow);
        if (shadow->weakest < wanted) {
            wanted = shadow->weakest;
            walk.line = tree_segment_in_float(segment, error, wanted);
        }
    }
}

/* Margin of the light point's being hidden; *hides gets whether it is. Where it is not, a margin of at least
 * 1 may be larger with a tree. */
static inline double shadow_margin(const struct packed_scene *scene, const struct segment *segment,
                                   struct ray_error error, bool *hides)
{
    struct shadow shadow = {.weakest = INFINITY};
    for (int i = 0; i < tried_spheres(scene); ++i)
        add_sphere(scene, i, segment, error, &shadow);
    if (scene->tree)
        add_tree_spheres(scene, segment, error, &shadow);
    for (int i = 0; i < scene->plane_count; ++i) {
        bool blocks;
        double margin =
            plane_block_margin(&scene->planes[i], scene->sphere_count + i, segment, error.origin, &blocks);
        add_blocker(&shadow, blocks, margin);
    }
    *hides = shadow.hides;
    return shadow.hides ? shadow.strongest_block : shadow.weakest;
}

static const double nearest_light = 0x1p-30; /* the root of NEAREST_LIGHT_SQUARED */

/* What float may be off by at the matte point. */
struct point_errors {
    struct hit_error hit;
    struct errors ray_direction;
};

/* A point of a light as the matte point sees it. */
struct tracked_sample {
    struct vec3 direction; /* to it, 0 where float knows none */
    struct errors e_direction;
    double received, error; /* as of receive() */
    double margin;          /* of its being lit or not */
    bool may_hide;          /* in float, or is hidden and may be not: the error is all that it may bring */
};

/* Oren-Nayar's factor where the light is visible, with its error. */
static inline double track_factor(const struct matte_point *matte, const struct point_errors *point,
                                  const struct tracked_sample *sample, double cos_in, double e_cos_in,
                                  double *error)
{
    const PackedSurface *material = matte->hit->material;
    const struct vec3 to_light = sample->direction, along = matte->ray->direction;
    const double a = (double)material->parameters.OREN_NAYAR_A,
                 b = (double)material->more_parameters.OREN_NAYAR_B;
    const double cos_out = fabs((double)matte->cos_out), in = larger(cos_in, 0);
    const double e_cos_out = dot_error(matte->hit->normal, point->hit.normal, along, point->ray_direction);
    /* The factor (a + b s / larger) cos_in is continuous, so neither s > 0 nor cos_in > 0 is a decision. */
    const double s = larger(-(double)dot(to_light, along) - cos_in * cos_out, 0);
    const double larger_cos = larger(larger(cos_in, cos_out), e_cos_in);
    const double e_s = dot_error(to_light, sample->e_direction, along, point->ray_direction) +
                       cos_out * e_cos_in + cos_in * e_cos_out + unit_roundoff * (s + 2 * in * cos_out);
    const double ratio = s / larger_cos, factor = (a + b * ratio) * in;
    *error = (a + b * ratio) * e_cos_in +
             b * smaller(1, (in + e_cos_in) / larger_cos) * (e_s + ratio * (e_cos_in + e_cos_out)) +
             4 * unit_roundoff * factor;
    *error = smaller(*error, a + b); /* the factor is in [0, a + b] */
    return factor;
}

/* As receive(), with its error and the margin of its being lit, for a point light (quad NULL) or a point of a
 * quad. */
static inline struct tracked_sample
track_receive(const struct packed_scene *scene, const struct matte_point *matte,
              const struct point_errors *point, const struct PackedQuadLight *quad, struct vec3 light,
              struct errors e_light, struct vec3 *to_light, struct tally *tally)
{
    const struct hit *hit = matte->hit;
    struct tracked_sample sample = {.received = (double)receive(scene, matte, light, to_light, tally)};
    const struct vec3 way = subtract(light, hit->point);
    const struct errors e_way = errors_add(errors_add(point->hit.point, e_light), errors_of(1, way));
    const double distance = length(way), off = errors_length(e_way);
    if (distance - off <= nearest_light) { /* too near to shine, or perhaps not, and from wherever */
        sample.error = 2 / NEAREST_LIGHT_SQUARED;
        sample.e_direction = (struct errors){1, 1, 1, 1};
        sample.may_hide = true;
        return sample;
    }
    sample.direction = scale(1 / (real)distance, way);
    sample.e_direction = unit_errors(sample.direction, errors_scale(1 / (distance - off), e_way));
    const double cos_in = (double)dot(hit->normal, sample.direction);
    const double e_cos_in = dot_error(hit->normal, point->hit.normal, sample.direction, sample.e_direction);
    sample.margin = INFINITY;
    TELL(note_light_bounds(errors_vector(e_light), length_error(distance, off), e_cos_in, 0, INFINITY));
    if (cos_in < -e_cos_in)
        return sample;
    double e_factor, factor = track_factor(matte, point, &sample, cos_in, e_cos_in, &e_factor);
    const struct segment segment = {hit->point,     light,        sample.direction,
                                    (real)distance, hit->surface, hit->from_inside};
    const double nearest =
        distance - smaller(errors_weigh(sample.direction, e_way) + off * off / (distance - off), off);
    const double falloff = 1 / (distance * distance), largest_falloff = 1 / (nearest * nearest);
    struct conjunction lit = conjunction_begin();
    bool hides = false;
    const struct ray_error error = {errors_length(point->hit.point), errors_length(sample.e_direction)};
    const double shadow = shadow_margin(scene, &segment, error, &hides);
    sample.may_hide = shadow < 1;
    if (!hides || sample.may_hide)
        sample.error = (factor + e_factor) * largest_falloff - (sample.may_hide ? 0 : factor * falloff) +
                       9 * unit_roundoff * factor * falloff;
    require_positive(&lit, cos_in, e_cos_in);
    require_positive(&lit, hides ? -shadow : shadow, 1);
    if (quad)
        require_positive(
            &lit, (double)dot(vector_of(quad->area_normal), sample.direction),
            dot_error(vector_of(quad->area_normal), no_errors, sample.direction, sample.e_direction));
    sample.margin = conjunction_margin(&lit);
    TELL(note_light_bounds(errors_vector(e_light), length_error(distance, off), e_cos_in, sample.error,
                           sample.margin));
    return sample;
}

/* What reflect_lights() adds up, without albedo, and how far it may be off in float, for each channel. */
struct tracked_light {
    struct vec3 radiance;
    struct vec3 rounding; /* as long as float has the same points hidden */
    struct vec3 shadow;   /* by the others */
    double margin;        /* of the closest decision */
};

/* Adds what is received of a light of that intensity. */
static inline void add_light(struct tracked_light *light, layout_vec4 intensity, double received,
                             double rounding_error, double shadow_error)
{
    struct vec3 each = vector_of(intensity);
    light->radiance = add(light->radiance, scale((real)received, each));
    light->rounding = add(light->rounding, scale((real)(rounding_error + rounding(received)), each));
    light->shadow = add(light->shadow, scale((real)shadow_error, each));
}

static inline void track_quad(const struct packed_scene *scene, int number, const struct matte_point *matte,
                              const struct point_errors *point, uint32_t seed, uint32_t pixel_sample,
                              struct tally *tally, struct tracked_light *result)
{
    const struct PackedQuadLight *quad = &scene->quad_lights[number];
    struct vec3 edge_u = vector_of(quad->edge_u), edge_v = vector_of(quad->edge_v), to_light = {0, 0, 0};
    const struct vec3 area = vector_of(quad->area_normal);
    double sum = 0, errors[] = {0, 0};
    const uint32_t first = sobol_block(seed, pixel_sample, scene->light_samples);
    for (int k = 0; k < scene->light_samples; ++k) {
        real u, v;
        sobol_point(seed, first + (uint32_t)k, &u, &v);
        struct vec3 light = add(add(vector_of(quad->corner), scale(u, edge_u)), scale(v, edge_v));
        struct errors e_light = errors_add(errors_of(1, scale(u, edge_u)), errors_of(1, scale(v, edge_v)));
        e_light = errors_add(
            e_light, errors_add(errors_of(2, light), errors_of(1, subtract(light, scale(v, edge_v)))));
        struct tracked_sample sample =
            track_receive(scene, matte, point, quad, light, e_light, &to_light, tally);
        real projected = dot(area, to_light);
        bool lit = sample.received > 0 && projected > 0;
        note(tally, lit);
        double e_projected =
            dot_error(area, no_errors, sample.direction, sample.e_direction) + FLT_MIN; /* denormal */
        double largest = larger((double)dot(area, sample.direction) + e_projected, 0);
        TELL(event_light.area_bound = e_projected);
        TELL(record_light(scene->point_light_count + number, k, light, projected));
        sum += lit ? sample.received * (double)projected : 0;
        errors[sample.may_hide] += sample.error * largest + sample.received * smaller(e_projected, largest);
        result->margin = smaller(result->margin, sample.margin);
    }
    errors[0] += scene->light_samples * unit_roundoff * sum; /* the plain sum's */
    add_light(result, quad->radiance, sum, errors[0], errors[1]);
}

/* As reflect_lights(), through the same points in the same order. */
static inline struct tracked_light track_lights(const struct packed_scene *scene, const struct ray *ray,
                                                const struct hit *hit, const struct point_errors *point,
                                                uint32_t seed, uint32_t pixel_sample, struct tally *tally)
{
    struct matte_point matte = {ray, hit, -dot(hit->normal, ray->direction)};
    struct tracked_light light = {.margin = INFINITY};
    for (int i = 0; i < scene->point_light_count; ++i) {
        struct vec3 position = vector_of(scene->point_lights[i].position), to_light;
        struct tracked_sample sample =
            track_receive(scene, &matte, point, NULL, position, no_errors, &to_light, tally);
        note(tally, sample.received > 0);
        TELL(record_light(i, 0, position, 1));
        add_light(&light, scene->point_lights[i].intensity, sample.received,
                  sample.may_hide ? 0 : sample.error, sample.may_hide ? sample.error : 0);
        light.margin = smaller(light.margin, sample.margin);
    }
    for (int i = 0; i < scene->quad_light_count; ++i)
        track_quad(scene, i, &matte, point, seed + (uint32_t)i, pixel_sample, tally, &light);
    double sums = (scene->point_light_count + scene->quad_light_count) * unit_roundoff;
    light.rounding = add(light.rounding, scale((real)sums, light.radiance)); /* the plain sum's */
    return light;
}

#endif
