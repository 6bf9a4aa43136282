/* What a matte point reflects of the lights: Oren-Nayar, point and quad lights, shadows. */
#ifndef REFERENCE_MATTE_H
#define REFERENCE_MATTE_H

#include "events.h"
#include "geometry.h"
#include "sobol.h"

struct matte_point {
    const struct ray *ray;
    const struct hit *hit;
    real cos_out; /* of the angle between normal and the way back */
};

/* Oren-Nayar without albedo / pi, times cos_in: Oren and Nayar, "Generalization of Lambert's Reflectance
 * Model", SIGGRAPH 1994; cos(phi_i - phi_o) sin alpha tan beta = s / max(cos_in, cos_out) with s = to_light .
 * to_eye - cos_in cos_out, where s > 0. */
static inline real oren_nayar(real a, real b, struct vec3 to_light, struct vec3 ray_direction, real cos_in,
                              real cos_out)
{
    real s = -dot(to_light, ray_direction) - cos_in * cos_out;
    real larger_cos = cos_in > cos_out ? cos_in : cos_out;
    return (a + b * (s > 0 ? s / larger_cos : 0)) * cos_in;
}

/* The light point's share of radiance per unit of intensity and of albedo / pi: 0 if it is behind the surface
 * or hidden. *to_light is the unit direction to it. */
static inline real receive(const struct packed_scene *scene, const struct matte_point *matte,
                           struct vec3 light, struct vec3 *to_light, struct tally *tally)
{
    const struct hit *hit = matte->hit;
    struct vec3 way = subtract(light, hit->point);
    real distance_squared = dot(way, way);
    TELL(note_light(LIGHT_TOO_NEAR, 0, 0));
    if (!(distance_squared > (real)NEAREST_LIGHT_SQUARED))
        return 0;
    real distance = square_root(distance_squared);
    real inverse = 1 / distance;
    *to_light = scale(inverse, way);
    real cos_in = dot(hit->normal, *to_light);
    TELL(note_light(LIGHT_BEHIND, distance, cos_in));
    if (!(cos_in > 0))
        return 0;
    ++tally->rays.shadow;
    TELL(note_light(LIGHT_SHADOW_RAY, distance, cos_in));
    struct segment segment = {
        .from = hit->point,
        .to = light,
        .direction = *to_light,
        .length = distance,
        .surface = hit->surface,
        .inward = hit->from_inside,
    };
    if (is_blocked(scene, &segment)) {
        TELL(event_light.blocker = find_blocker(scene, &segment, false));
        return 0;
    }
    real factor =
        oren_nayar(hit->material->parameters.OREN_NAYAR_A, hit->material->more_parameters.OREN_NAYAR_B,
                   *to_light, matte->ray->direction, cos_in, matte->cos_out);
    TELL(event_light.values.z = factor * (inverse * inverse));
    return factor * (inverse * inverse);
}

static inline struct vec3 receive_quad(const struct packed_scene *scene, const struct matte_point *matte,
                                       const struct PackedQuadLight *quad, uint32_t seed,
                                       uint32_t pixel_sample, struct tally *tally)
{
    struct vec3 edge_u = vector_of(quad->edge_u), edge_v = vector_of(quad->edge_v);
    real sum = 0;
    const uint32_t first = sobol_block(seed, pixel_sample, scene->light_samples);
    for (int k = 0; k < scene->light_samples; ++k) {
        real u, v;
        sobol_point(seed, first + (uint32_t)k, &u, &v);
        struct vec3 light = add(add(vector_of(quad->corner), scale(u, edge_u)), scale(v, edge_v));
        struct vec3 to_light = {0, 0, 0};
        real received = receive(scene, matte, light, &to_light, tally);
        real projected_area = dot(vector_of(quad->area_normal), to_light);
        bool lit = received > 0 && projected_area > 0;
        note(tally, lit);
        TELL(record_light(scene->point_light_count + (int)(quad - scene->quad_lights), k, light,
                          projected_area));
        if (lit)
            sum = sum + received * projected_area;
    }
    return scale(sum, vector_of(quad->radiance));
}

/* Radiance that the matte hit sends back along the ray. */
static inline struct vec3 reflect_lights(const struct packed_scene *scene, const struct ray *ray,
                                         const struct hit *hit, uint32_t seed, uint32_t pixel_sample,
                                         struct tally *tally)
{
    struct matte_point matte = {ray, hit, -dot(hit->normal, ray->direction)};
    struct vec3 sum = {0, 0, 0};
    for (int i = 0; i < scene->point_light_count; ++i) {
        struct vec3 to_light;
        real received = receive(scene, &matte, vector_of(scene->point_lights[i].position), &to_light, tally);
        note(tally, received > 0);
        TELL(record_light(i, 0, vector_of(scene->point_lights[i].position), 1));
        sum = add(sum, scale(received, vector_of(scene->point_lights[i].intensity)));
    }
    for (int i = 0; i < scene->quad_light_count; ++i)
        sum = add(sum, receive_quad(scene, &matte, &scene->quad_lights[i], seed + (uint32_t)i, pixel_sample,
                                    tally));
    return multiply(vector_of(hit->material->parameters), sum);
}

#endif
