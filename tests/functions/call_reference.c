/* The functions of the C reference, on the records of functions.comp. */
#include "function_table.h"

#include "dielectric.h"
#include "matte.h"
#include "sobol.h"

void call_unit(const unit_input *input, unit_output *output)
{
    output->unit_vector = normalize(input->vector);
}

void call_sobol_point(const sobol_point_input *input, sobol_point_output *output)
{
    sobol_point((uint32_t)input->seed, (uint32_t)input->index, &output->u, &output->v);
}

static struct ray ray_of(const RayRecord *ray)
{
    return (struct ray){ray->origin, ray->direction, ray->surface, ray->inward != 0};
}

/* All 0 where nothing was met. */
static HitRecord record_of(bool met, const struct hit *hit)
{
    return met ? (HitRecord){1, hit->distance, hit->from_inside, hit->point, hit->normal} : (HitRecord){0};
}

/* A scene of nothing but a sphere, which is a giant if it has a curvature. */
struct sphere_scene {
    Sphere sphere;
    PackedSurface surface;
    struct packed_scene scene;
};

static void set_sphere_scene(struct sphere_scene *set, Sphere sphere, float curvature)
{
    *set = (struct sphere_scene){
        .sphere = sphere,
        .surface.more_parameters.CURVATURE = curvature,
        .scene = {.sphere_count = 1,
                  .looped_spheres = 1,
                  .giants = curvature > 0,
                  .spheres = &set->sphere,
                  .surfaces = &set->surface},
    };
}

void call_meet_sphere(const meet_sphere_input *input, meet_sphere_output *output)
{
    const struct ray ray = ray_of(&input->ray);
    struct sphere_scene set;
    struct hit hit;
    set_sphere_scene(&set, input->sphere, input->curvature);
    output->hit = record_of(find_hit(&set.scene, &ray, &hit), &hit);
}

/* The plane is surface 1 of a scene that has a sphere. */
void call_meet_plane(const meet_plane_input *input, meet_plane_output *output)
{
    const struct ray ray = ray_of(&input->ray);
    struct hit hit = {.surface = 1};
    bool met = meet_plane(&input->plane, 1, &ray, &hit.distance, &hit.from_inside) &&
               hit.distance < (real)FARTHEST_HIT;
    Plane plane = input->plane;
    if (met)
        locate(&(struct packed_scene){.sphere_count = 1, .plane_count = 1, .planes = &plane}, &ray, &hit);
    output->hit = record_of(met, &hit);
}

void call_nearest_hit(const nearest_hit_input *input, nearest_hit_output *output)
{
    const struct ray ray = ray_of(&input->ray);
    Sphere spheres[] = {input->sphere_0, input->sphere_1};
    Plane planes[] = {input->plane_0, input->plane_1};
    PackedSurface surface = {.tags = {0}};
    struct hit hit;
    bool met = find_hit(&(struct packed_scene){.sphere_count = 2,
                                               .looped_spheres = 2,
                                               .plane_count = 2,
                                               .spheres = spheres,
                                               .surfaces = &surface,
                                               .planes = planes},
                        &ray, &hit);
    output->surface = met ? hit.surface : NO_SURFACE;
    output->file_order = met ? hit.file_order : 0;
    output->hit = record_of(met, &hit);
}

static struct segment segment_of(const SegmentRecord *segment)
{
    return (struct segment){segment->from,     segment->to,      segment->direction,
                            segment->distance, segment->surface, segment->inward != 0};
}

void call_sphere_shadows(const sphere_shadows_input *input, sphere_shadows_output *output)
{
    const struct segment segment = segment_of(&input->segment);
    struct sphere_scene set;
    set_sphere_scene(&set, input->sphere, input->curvature);
    output->shadows = is_blocked(&set.scene, &segment);
}

void call_plane_shadows(const plane_shadows_input *input, plane_shadows_output *output)
{
    const struct segment segment = segment_of(&input->segment);
    output->shadows = plane_blocks(&input->plane, 1, &segment);
}

void call_reflect(const reflect_input *input, reflect_output *output)
{
    output->reflected_direction = reflect(input->direction, input->normal, input->cos_in);
}

void call_refract(const refract_input *input, refract_output *output)
{
    struct refraction refraction =
        refract(input->direction, input->normal, input->cos_in, input->eta, input->kappa);
    output->total = refraction.total;
    output->refracted_direction = refraction.total ? (Vector){0} : refraction.direction;
    output->reflectance = refraction.total ? 0 : refraction.reflectance;
}

void call_oren_nayar(const oren_nayar_input *input, oren_nayar_output *output)
{
    output->factor = oren_nayar(input->matte.a, input->matte.b, input->to_light, input->matte.ray_direction,
                                input->cos_in, input->matte.cos_out);
}

/* A matte point in a scene of one sphere and one plane. */
struct matte_scene {
    struct ray ray;
    struct hit hit;
    PackedSurface material;
    struct matte_point matte;
    Sphere sphere;
    Plane plane;
    struct packed_scene scene;
};

static void set_matte_scene(struct matte_scene *set, const MatteRecord *matte, Sphere sphere, Plane plane)
{
    *set = (struct matte_scene){
        .ray.direction = matte->ray_direction,
        .hit = {.surface = matte->surface,
                .from_inside = matte->inward != 0,
                .point = matte->point,
                .normal = matte->normal,
                .material = &set->material},
        .material = {.parameters.OREN_NAYAR_A = matte->a, .more_parameters.OREN_NAYAR_B = matte->b},
        .matte = {&set->ray, &set->hit, matte->cos_out},
        .sphere = sphere,
        .plane = plane,
        .scene = {.sphere_count = 1,
                  .looped_spheres = 1,
                  .surfaces = &set->material,
                  .plane_count = 1,
                  .spheres = &set->sphere,
                  .planes = &set->plane,
                  .light_samples = QUAD_LIGHT_SAMPLES},
    };
}

void call_point_light(const point_light_input *input, point_light_output *output)
{
    struct matte_scene set;
    set_matte_scene(&set, &input->matte, input->sphere, input->plane);
    struct tally tally = {0};
    struct vec3 to_light = {0};
    output->irradiance = receive(&set.scene, &set.matte, input->light, &to_light, &tally);
    output->shadow_rays = (int)tally.rays.shadow;
    output->to_light = tally.rays.shadow > 0 ? to_light : (Vector){0};
}

void call_quad_light(const quad_light_input *input, quad_light_output *output)
{
    struct matte_scene set;
    set_matte_scene(&set, &input->matte, input->sphere, input->plane);
    struct tally tally = {0};
    output->radiance = receive_quad(&set.scene, &set.matte, &input->light, (uint32_t)input->seed,
                                    (uint32_t)input->pixel_sample, &tally);
    output->shadow_rays = (int)tally.rays.shadow;
}
