/* The functions of the C reference, in the order of the words that functions.comp reads and writes. */
#include "call_reference.h"

#include "dielectric.h"
#include "matte.h"
#include "sobol.h"

void call_divide(const union word *inputs, struct word_writer *outputs)
{
    real dividend = get_real(&inputs), divisor = get_real(&inputs);
    put_real(outputs, "quotient", dividend / divisor);
}

void call_square_root(const union word *inputs, struct word_writer *outputs)
{
    put_real(outputs, "root", square_root(get_real(&inputs)));
}

void call_unit(const union word *inputs, struct word_writer *outputs)
{
    put_vector(outputs, "unit vector", normalize(get_vector(&inputs)));
}

void call_hash(const union word *inputs, struct word_writer *outputs)
{
    put_integer(outputs, "hash", hash32(get_integer(&inputs)));
}

void call_sobol_point(const union word *inputs, struct word_writer *outputs)
{
    uint32_t seed = get_integer(&inputs), index = get_integer(&inputs);
    real u, v;
    sobol_point(seed, index, &u, &v);
    put_real(outputs, "u", u);
    put_real(outputs, "v", v);
}

static struct ray get_ray(const union word **next)
{
    struct ray ray;
    ray.origin = get_vector(next);
    ray.direction = get_vector(next);
    ray.surface = (int)get_integer(next);
    ray.inward = get_integer(next) != 0;
    return ray;
}

static PackedSurface get_surface(const union word **next)
{
    PackedSurface surface = {0};
    surface.tags.SURFACE_KIND = (int)get_integer(next);
    surface.tags.FILE_ORDER = (int)get_integer(next);
    surface.tags.HOLDS_RAYS = (int)get_integer(next);
    surface.tags.HOLDS_LIGHTS = (int)get_integer(next);
    return surface;
}

static struct PackedSphere get_sphere(const union word **next)
{
    struct PackedSphere sphere;
    sphere.center_radius = get_vec4(next);
    sphere.surface = get_surface(next);
    return sphere;
}

static struct PackedPlane get_plane(const union word **next)
{
    struct PackedPlane plane;
    plane.normal_offset = get_vec4(next);
    plane.surface = get_surface(next);
    return plane;
}

static void put_hit(struct word_writer *outputs, bool met, const struct hit *hit)
{
    put_integer(outputs, "met", met);
    put_real(outputs, "distance", met ? hit->distance : 0);
    put_integer(outputs, "from_inside", met && hit->from_inside);
}

static void put_hit_point(struct word_writer *outputs, bool met, const struct hit *hit)
{
    const struct vec3 none = {0, 0, 0};
    put_integer(outputs, "met", met);
    put_vector(outputs, "point", met ? hit->point : none);
    put_vector(outputs, "normal", met ? hit->normal : none);
}

/* A scene of one sphere and one plane: surfaces 0 and 1. */
struct small_scene {
    struct PackedSphere sphere;
    struct PackedPlane plane;
    struct packed_scene scene;
};

static void refer(struct small_scene *small)
{
    small->scene = (struct packed_scene){
        .sphere_count = 1,
        .plane_count = 1,
        .spheres = &small->sphere,
        .planes = &small->plane,
        .light_samples = QUAD_LIGHT_SAMPLES,
    };
}

/* Whether the ray meets the surface, nearer than FARTHEST_HIT as find_hit demands. */
static bool meet(const union word *inputs, int surface, struct hit *hit, struct ray *ray,
                 struct small_scene *small)
{
    *hit = (struct hit){.surface = surface};
    *ray = get_ray(&inputs);
    bool met;
    if (surface == 0) {
        small->sphere = get_sphere(&inputs);
        met = meet_sphere(&small->sphere, 0, ray, &hit->distance, &hit->from_inside);
    } else {
        small->plane = get_plane(&inputs);
        met = meet_plane(&small->plane, 1, ray, &hit->distance, &hit->from_inside);
    }
    return met && hit->distance < (real)FARTHEST_HIT;
}

static void call_meet(const union word *inputs, int surface, struct word_writer *outputs)
{
    struct small_scene small;
    struct hit hit;
    struct ray ray;
    bool met = meet(inputs, surface, &hit, &ray, &small);
    put_hit(outputs, met, &hit);
}

static void call_hit_point(const union word *inputs, int surface, struct word_writer *outputs)
{
    struct small_scene small;
    refer(&small);
    struct hit hit;
    struct ray ray;
    bool met = meet(inputs, surface, &hit, &ray, &small);
    if (met)
        locate(&small.scene, &ray, &hit);
    put_hit_point(outputs, met, &hit);
}

void call_meet_sphere(const union word *inputs, struct word_writer *outputs)
{
    call_meet(inputs, 0, outputs);
}

void call_meet_plane(const union word *inputs, struct word_writer *outputs)
{
    call_meet(inputs, 1, outputs);
}

void call_sphere_hit_point(const union word *inputs, struct word_writer *outputs)
{
    call_hit_point(inputs, 0, outputs);
}

void call_plane_hit_point(const union word *inputs, struct word_writer *outputs)
{
    call_hit_point(inputs, 1, outputs);
}

void call_nearest_hit(const union word *inputs, struct word_writer *outputs)
{
    struct ray ray = get_ray(&inputs);
    struct PackedSphere spheres[2];
    struct PackedPlane planes[2];
    for (int i = 0; i < 2; ++i)
        spheres[i] = get_sphere(&inputs);
    for (int i = 0; i < 2; ++i)
        planes[i] = get_plane(&inputs);
    const struct packed_scene scene = {
        .sphere_count = 2, .plane_count = 2, .spheres = spheres, .planes = planes};
    struct hit hit;
    bool met = find_hit(&scene, &ray, &hit);
    put_integer(outputs, "surface", met ? (uint32_t)hit.surface : (uint32_t)NO_SURFACE);
    put_integer(outputs, "rank", met ? (uint32_t)hit.material->tags.FILE_ORDER : 0);
    put_hit(outputs, met, &hit);
    put_hit_point(outputs, met, &hit);
}

static struct segment get_segment(const union word **next)
{
    struct segment segment;
    segment.from = get_vector(next);
    segment.to = get_vector(next);
    segment.direction = get_vector(next);
    segment.length = get_real(next);
    segment.surface = (int)get_integer(next);
    segment.inward = get_integer(next) != 0;
    return segment;
}

void call_sphere_shadows(const union word *inputs, struct word_writer *outputs)
{
    struct segment segment = get_segment(&inputs);
    struct PackedSphere sphere = get_sphere(&inputs);
    put_integer(outputs, "shadows", sphere_blocks(&sphere, 0, &segment));
}

void call_plane_shadows(const union word *inputs, struct word_writer *outputs)
{
    struct segment segment = get_segment(&inputs);
    struct PackedPlane plane = get_plane(&inputs);
    put_integer(outputs, "shadows", plane_blocks(&plane, 1, &segment));
}

void call_reflect(const union word *inputs, struct word_writer *outputs)
{
    struct vec3 direction = get_vector(&inputs), normal = get_vector(&inputs);
    put_vector(outputs, "reflected", reflect(direction, normal, get_real(&inputs)));
}

static struct refraction get_refraction(const union word *inputs)
{
    struct vec3 direction = get_vector(&inputs), normal = get_vector(&inputs);
    real cos_in = get_real(&inputs), eta = get_real(&inputs), kappa = get_real(&inputs);
    return refract(direction, normal, cos_in, eta, kappa);
}

void call_refract(const union word *inputs, struct word_writer *outputs)
{
    struct refraction refraction = get_refraction(inputs);
    const struct vec3 none = {0, 0, 0};
    put_integer(outputs, "total", refraction.total);
    put_vector(outputs, "refracted", refraction.total ? none : refraction.direction);
}

void call_fresnel(const union word *inputs, struct word_writer *outputs)
{
    struct refraction refraction = get_refraction(inputs);
    put_integer(outputs, "total", refraction.total);
    put_real(outputs, "reflectance", refraction.total ? 0 : refraction.reflectance);
}

/* What the harness gives of a matte hit. */
struct matte_words {
    struct ray ray;
    struct hit hit;
    PackedSurface material;
    struct matte_point matte;
};

static void get_matte(const union word **next, struct matte_words *words)
{
    words->hit.point = get_vector(next);
    words->hit.normal = get_vector(next);
    words->ray.direction = get_vector(next);
    words->matte = (struct matte_point){&words->ray, &words->hit, get_real(next)};
    words->hit.surface = (int)get_integer(next);
    words->hit.from_inside = get_integer(next) != 0;
    words->hit.material = &words->material;
    words->material.parameters.OREN_NAYAR_A = get_real(next);
    words->material.more_parameters.OREN_NAYAR_B = get_real(next);
}

void call_oren_nayar(const union word *inputs, struct word_writer *outputs)
{
    struct matte_words words;
    get_matte(&inputs, &words);
    struct vec3 to_light = get_vector(&inputs);
    put_real(outputs, "factor",
             oren_nayar(words.material.parameters.OREN_NAYAR_A, words.material.more_parameters.OREN_NAYAR_B,
                        to_light, words.ray.direction, get_real(&inputs), words.matte.cos_out));
}

void call_point_light(const union word *inputs, struct word_writer *outputs)
{
    struct matte_words words;
    get_matte(&inputs, &words);
    struct vec3 light = get_vector(&inputs), to_light = {0, 0, 0};
    struct small_scene small;
    refer(&small);
    small.sphere = get_sphere(&inputs);
    small.plane = get_plane(&inputs);
    struct tally tally = {0};
    put_real(outputs, "irradiance", receive(&small.scene, &words.matte, light, &to_light, &tally));
    put_integer(outputs, "shadow rays", (uint32_t)tally.rays.shadow);
    put_vector(outputs, "to light", tally.rays.shadow > 0 ? to_light : (struct vec3){0, 0, 0});
}

void call_quad_light(const union word *inputs, struct word_writer *outputs)
{
    struct matte_words words;
    get_matte(&inputs, &words);
    struct PackedQuadLight quad;
    quad.corner = get_vec4(&inputs);
    quad.edge_u = get_vec4(&inputs);
    quad.edge_v = get_vec4(&inputs);
    quad.area_normal = get_vec4(&inputs);
    quad.radiance = get_vec4(&inputs);
    uint32_t seed = get_integer(&inputs), pixel_sample = get_integer(&inputs);
    struct small_scene small;
    refer(&small);
    small.sphere = get_sphere(&inputs);
    small.plane = get_plane(&inputs);
    struct tally tally = {0};
    put_vector(outputs, "radiance",
               receive_quad(&small.scene, &words.matte, &quad, seed, pixel_sample, &tally));
    put_integer(outputs, "shadow rays", (uint32_t)tally.rays.shadow);
}
