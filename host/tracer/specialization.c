#include "tracer/specialization.h"

#include "scene/body.h"

enum { MOST_HOISTED = 24 };

static void note_surface(struct specialization *constants, const struct packed_scene *scene,
                         const PackedSurface *surface)
{
    if (surface->tags.SURFACE_KIND == KIND_MATTE &&
        (surface->parameters.OREN_NAYAR_A != scene->view.matte.SHARED_A ||
         surface->more_parameters.OREN_NAYAR_B != scene->view.matte.SHARED_B))
        constants->one_roughness = VK_FALSE;
    constants->mirrors |= surface->tags.SURFACE_KIND == KIND_MIRROR;
    constants->glass |= surface->tags.SURFACE_KIND == KIND_TRANSPARENT;
    constants->rough |=
        surface->tags.SURFACE_KIND == KIND_MATTE && surface->more_parameters.OREN_NAYAR_B != 0;
}

static uint32_t plane_axis(layout_vec4 normal)
{
    if (normal.y == 0 && normal.z == 0)
        return 1;
    if (normal.x == 0 && normal.z == 0)
        return 2;
    return normal.x == 0 && normal.y == 0 ? 3 : 0;
}

struct specialization specialize(const struct packed_scene *scene, const struct dispatch_size *size,
                                 const struct tracer_options *options)
{
    struct specialization constants = {
        .group_width = size->group_width,
        .group_height = size->group_height,
        .spheres = scene->looped_spheres,
        .planes = scene->plane_count,
        .point_lights = scene->point_light_count,
        .quad_lights = scene->quad_light_count,
        .max_bounces = scene->max_bounces,
        .samples = scene->samples,
        .light_samples = scene->light_samples,
        .one_roughness = VK_TRUE,
        .columns = size->columns,
        .counts = options->counts,
        .prunes = scene->view.truncation.ALLOWANCE >= 0,
        .charges = options->charges,
        .resumable = size->resumable,
        .rays_escape = scene->view.between_mirrors.w != 0,
        .processor = size->on_processor,
        .light_points_a_turn = size->light_points_a_turn,
        .giants = scene->giants,
        .hoisted = size->on_processor && scene->looped_spheres + scene->plane_count +
                                                 scene->point_light_count + scene->quad_light_count <=
                                             MOST_HOISTED,
        .primary_rays_first = size->primary_rays_first && options->event_room == 0,
        .all_spheres = scene->sphere_count,
        .most_steps = size->most_steps,
    };
    int last_sphere_order = -1;
    for (int i = 0; i < packed_surface_count(scene); ++i)
        note_surface(&constants, scene, packed_surface(scene, i));
    for (int i = 0; i < scene->sphere_count; ++i) {
        const layout_ivec4 tags = scene->spheres[i].tags;
        constants.spheres_hold_rays |= tags.HOLDS_RAYS != 0;
        constants.spheres_hold_lights |= tags.HOLDS_LIGHTS != 0;
        if (i < scene->looped_spheres)
            last_sphere_order = tags.FILE_ORDER;
    }
    for (int i = 0; i < scene->plane_count; ++i) {
        const PackedSurface *surface = &scene->planes[i].surface;
        constants.glass_planes |= surface->tags.SURFACE_KIND == KIND_TRANSPARENT;
        constants.planes_shadow |= surface->tags.CASTS_SHADOWS != 0;
        constants.mixed_order |= surface->tags.FILE_ORDER < last_sphere_order;
        if (i < 16)
            constants.plane_axes |= plane_axis(scene->planes[i].normal_offset) << (2 * i);
    }
    return constants;
}

bool is_plain(const struct specialization *constants)
{
    return constants->quad_lights == 0 && !constants->counts && !constants->prunes && !constants->charges &&
           !constants->rays_escape && constants->processor && constants->giants == 0 && constants->hoisted;
}
