#include "scene/pack.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/truncation.h"
#include "scene/vector.h"

static const double pi = 3.14159265358979323846;

/* What float arithmetic on coordinates of size 1 cannot resolve, a few units in the last place, is taken as
 * touching, not as overlapping. */
static const double resolution = 0x1p-21;

/* Keeps the largest possible radiance, at NEAREST_LIGHT_SQUARED, far inside float. */
static const double brightest = 1e12;

struct packing {
    const struct scene *scene;
    double scale; /* from metres to scene units, a power of two */
    struct packed_scene *packed;
    const struct scene_object **sphere_sources, **plane_sources; /* for messages */
};

/* Nothing downstream sees a denormal: drivers differ in what they make of one. */
static float to_float(double x)
{
    return fabs(x) < (double)FLT_MIN ? 0 : (float)x;
}

static layout_vec4 to_vec4(struct dvec3 v, double w)
{
    return (layout_vec4){to_float(v.x), to_float(v.y), to_float(v.z), to_float(w)};
}

static double plane_offset(const struct scene_object *plane, struct dvec3 *normal)
{
    *normal = dvec3_unit(dvec3_of(plane->plane.normal));
    return dvec3_dot(*normal, dvec3_of(plane->plane.point));
}

static double scene_extent(const struct scene *scene)
{
    double extent = dvec3_largest(dvec3_of(scene->camera.position));
    for (size_t i = 0; i < scene->object_count; ++i) {
        const struct scene_object *object = &scene->objects[i];
        struct dvec3 normal;
        double reach = object->type == OBJECT_SPHERE
                           ? dvec3_largest(dvec3_of(object->sphere.center)) + object->sphere.radius
                           : fabs(plane_offset(object, &normal));
        extent = fmax(extent, reach);
    }
    for (size_t i = 0; i < scene->light_count; ++i) {
        const struct scene_light *light = &scene->lights[i];
        if (light->type == LIGHT_POINT) {
            extent = fmax(extent, dvec3_largest(dvec3_of(light->point.position)));
            continue;
        }
        for (int corner = 0; corner < 4; ++corner) {
            struct dvec3 point = dvec3_of(light->quad.corner);
            point = dvec3_add(point, dvec3_scale(corner & 1, dvec3_of(light->quad.u)));
            point = dvec3_add(point, dvec3_scale(corner >> 1, dvec3_of(light->quad.v)));
            extent = fmax(extent, dvec3_largest(point));
        }
    }
    return extent;
}

static void pack_view(struct packing *packing)
{
    const struct scene_camera *camera = &packing->scene->camera;
    struct packed_scene *packed = packing->packed;
    struct dvec3 position = dvec3_of(camera->position);
    struct dvec3 forward = dvec3_unit(dvec3_subtract(dvec3_of(camera->look_at), position));
    struct dvec3 right = dvec3_unit(dvec3_cross(forward, dvec3_unit(dvec3_of(camera->up))));
    struct dvec3 down = dvec3_cross(forward, right);
    double half_pixel = tan(camera->fov_y_degrees / 180 * pi / 2) / packed->height;
    packed->view = (struct PackedView){
        .position = to_vec4(dvec3_scale(packing->scale, position), 0),
        .forward = to_vec4(forward, 0),
        .half_pixel_right = to_vec4(dvec3_scale(half_pixel, right), 0),
        .half_pixel_down = to_vec4(dvec3_scale(half_pixel, down), 0),
        .background = to_vec4(dvec3_of(packing->scene->background), 0),
    };
}

static PackedSurface pack_surface(const struct scene *scene, const struct scene_object *object)
{
    const struct scene_material *material = &scene->materials[object->material];
    PackedSurface surface = {.tags.FILE_ORDER = (int)(object - scene->objects)};
    double sigma_squared = material->roughness * material->roughness;
    switch (material->type) {
    case MATERIAL_MATTE:
        surface.tags.SURFACE_KIND = KIND_MATTE;
        surface.parameters = to_vec4(dvec3_scale(1 / pi, dvec3_of(material->color)),
                                     1 - 0.5 * sigma_squared / (sigma_squared + 0.33));
        surface.more_parameters.OREN_NAYAR_B = to_float(0.45 * sigma_squared / (sigma_squared + 0.09));
        break;
    case MATERIAL_MIRROR:
        surface.tags.SURFACE_KIND = KIND_MIRROR;
        break;
    case MATERIAL_TRANSPARENT:
        surface.tags.SURFACE_KIND = KIND_TRANSPARENT;
        surface.parameters.ETA_ENTERING = to_float(1 / material->ior);
        surface.parameters.KAPPA_ENTERING =
            to_float((material->ior - 1) * (material->ior + 1) / (material->ior * material->ior));
        surface.parameters.ETA_EXITING = to_float(material->ior);
        surface.parameters.KAPPA_EXITING = to_float((1 - material->ior) * (1 + material->ior));
        break;
    }
    return surface;
}

static bool same_vec4(layout_vec4 a, layout_vec4 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

/* An object that coincides with an opaque one before it is never met: ties go to the first. */
static void pack_sphere(struct packing *packing, const struct scene_object *object)
{
    struct packed_scene *packed = packing->packed;
    struct PackedSphere sphere = {
        .center_radius = to_vec4(dvec3_scale(packing->scale, dvec3_of(object->sphere.center)),
                                 packing->scale * object->sphere.radius),
        .surface = pack_surface(packing->scene, object),
    };
    for (int i = 0; i < packed->sphere_count; ++i)
        if (same_vec4(packed->spheres[i].center_radius, sphere.center_radius) &&
            packed->spheres[i].surface.tags.SURFACE_KIND != KIND_TRANSPARENT)
            return;
    packing->sphere_sources[packed->sphere_count] = object;
    packed->spheres[packed->sphere_count++] = sphere;
}

static void pack_plane(struct packing *packing, const struct scene_object *object)
{
    struct packed_scene *packed = packing->packed;
    struct dvec3 normal;
    double offset = packing->scale * plane_offset(object, &normal);
    struct dvec3 camera = dvec3_scale(packing->scale, dvec3_of(packing->scene->camera.position));
    struct PackedPlane plane = {.surface = pack_surface(packing->scene, object)};
    if (plane.surface.tags.SURFACE_KIND != KIND_TRANSPARENT && dvec3_dot(normal, camera) < offset) {
        normal = dvec3_scale(-1, normal);
        offset = -offset;
    }
    plane.normal_offset = to_vec4(normal, offset);
    for (int i = 0; i < packed->plane_count; ++i)
        if (same_vec4(packed->planes[i].normal_offset, plane.normal_offset) &&
            packed->planes[i].surface.tags.SURFACE_KIND != KIND_TRANSPARENT)
            return;
    packing->plane_sources[packed->plane_count] = object;
    packed->planes[packed->plane_count++] = plane;
}

static double plane_height(const struct PackedPlane *plane, struct dvec3 point)
{
    return dvec3_dot(dvec3_of_vec4(plane->normal_offset), point) - (double)plane->normal_offset.w;
}

static bool lies_behind(const struct PackedPlane *plane, struct dvec3 point)
{
    double size = dvec3_length(point) + fabs((double)plane->normal_offset.w);
    return plane_height(plane, point) < -resolution * size;
}

static enum status pack_point_light(struct packing *packing, const struct scene_light *light)
{
    struct packed_scene *packed = packing->packed;
    struct dvec3 intensity =
        dvec3_scale(light->power * packing->scale * packing->scale, dvec3_of(light->color));
    if (dvec3_largest(intensity) > brightest) {
        log_error("%s:%d:%d: point light: color times power must be at most %g times the square of the "
                  "scene's extent",
                  packing->scene->path, light->place.line, light->place.column, brightest);
        return STATUS_REFUSED;
    }
    struct dvec3 position = dvec3_scale(packing->scale, dvec3_of(light->point.position));
    for (int i = 0; i < packed->plane_count; ++i)
        if (packed->planes[i].surface.tags.SURFACE_KIND != KIND_TRANSPARENT &&
            lies_behind(&packed->planes[i], position))
            return STATUS_DONE; /* behind an opaque plane: it lights nothing that can be seen */
    packed->point_lights[packed->point_light_count++] = (struct PackedPointLight){
        .position = to_vec4(position, 0),
        .intensity = to_vec4(intensity, 0),
    };
    return STATUS_DONE;
}

static enum status pack_quad_light(struct packing *packing, const struct scene_light *light)
{
    struct packed_scene *packed = packing->packed;
    struct dvec3 corner = dvec3_scale(packing->scale, dvec3_of(light->quad.corner));
    struct dvec3 u = dvec3_scale(packing->scale, dvec3_of(light->quad.u));
    struct dvec3 v = dvec3_scale(packing->scale, dvec3_of(light->quad.v));
    struct dvec3 area_normal = dvec3_cross(u, v);
    struct dvec3 radiance = dvec3_scale(light->power, dvec3_of(light->color));
    if (dvec3_largest(radiance) > brightest) {
        log_error("%s:%d:%d: quad light: color times power must be at most %g", packing->scene->path,
                  light->place.line, light->place.column, brightest);
        return STATUS_REFUSED;
    }
    for (int i = 0; i < packed->plane_count; ++i)
        for (int k = 0; k < 4; ++k) {
            struct dvec3 point = dvec3_add(corner, dvec3_add(dvec3_scale(k & 1, u), dvec3_scale(k >> 1, v)));
            if (lies_behind(&packed->planes[i], point))
                packed->planes[i].surface.tags.CASTS_SHADOWS = 1;
        }
    packed->quad_lights[packed->quad_light_count++] = (struct PackedQuadLight){
        .corner = to_vec4(corner, 0),
        .edge_u = to_vec4(u, 0),
        .edge_v = to_vec4(v, 0),
        .area_normal = to_vec4(area_normal, 0),
        .radiance = to_vec4(dvec3_scale(1.0 / packed->light_samples, radiance), 0),
    };
    return STATUS_DONE;
}

/* Whether a surface at this distance from the sphere's centre reaches into the sphere. */
static bool reaches_into(double distance, layout_vec4 sphere)
{
    double radius = (double)sphere.w;
    return distance < radius - resolution * (dvec3_length(dvec3_of_vec4(sphere)) + radius);
}

/* Whether a ray or a shading point can lie within the sphere other than on it: the camera is in it, or it is
 * transparent and another surface reaches in. */
static bool holds_rays(const struct packed_scene *packed, int sphere)
{
    const struct PackedSphere *holder = &packed->spheres[sphere];
    struct dvec3 center = dvec3_of_vec4(holder->center_radius);
    double radius = (double)holder->center_radius.w;
    if (dvec3_length(dvec3_subtract(dvec3_of_vec4(packed->view.position), center)) < radius)
        return true;
    if (holder->surface.tags.SURFACE_KIND != KIND_TRANSPARENT)
        return false;
    for (int i = 0; i < packed->plane_count; ++i)
        if (reaches_into(fabs(plane_height(&packed->planes[i], center)), holder->center_radius))
            return true;
    for (int i = 0; i < packed->sphere_count; ++i) {
        layout_vec4 other = packed->spheres[i].center_radius;
        double apart = dvec3_length(dvec3_subtract(dvec3_of_vec4(other), center));
        if (i != sphere && reaches_into(fabs(apart - (double)other.w), holder->center_radius))
            return true;
    }
    return false;
}

/* Whether some point of a light may lie within the sphere; for quads, of the ball around them. */
static bool holds_lights(const struct packed_scene *packed, const struct PackedSphere *sphere)
{
    struct dvec3 center = dvec3_of_vec4(sphere->center_radius);
    double radius = (double)sphere->center_radius.w;
    for (int i = 0; i < packed->point_light_count; ++i) {
        struct dvec3 light = dvec3_of_vec4(packed->point_lights[i].position);
        if (dvec3_length(dvec3_subtract(light, center)) < radius)
            return true;
    }
    for (int i = 0; i < packed->quad_light_count; ++i) {
        const struct PackedQuadLight *quad = &packed->quad_lights[i];
        struct dvec3 u = dvec3_of_vec4(quad->edge_u), v = dvec3_of_vec4(quad->edge_v);
        struct dvec3 middle = dvec3_add(dvec3_of_vec4(quad->corner), dvec3_scale(0.5, dvec3_add(u, v)));
        double reach = (dvec3_length(u) + dvec3_length(v)) / 2;
        if (dvec3_length(dvec3_subtract(middle, center)) < radius + reach)
            return true;
    }
    return false;
}

static void warn_overlap(const struct packing *packing, const struct scene_object *a,
                         const struct scene_object *b)
{
    log_warning("%s:%d:%d: transparent bodies \"%s\" and \"%s\" overlap, which the model does not cover",
                packing->scene->path, b->place.line, b->place.column, a->name, b->name);
}

static void warn_of_overlaps(const struct packing *packing)
{
    const struct packed_scene *packed = packing->packed;
    for (int i = 0; i < packed->sphere_count; ++i) {
        if (packed->spheres[i].surface.tags.SURFACE_KIND != KIND_TRANSPARENT)
            continue;
        layout_vec4 a = packed->spheres[i].center_radius;
        for (int k = 0; k < i; ++k) {
            layout_vec4 b = packed->spheres[k].center_radius;
            if (packed->spheres[k].surface.tags.SURFACE_KIND == KIND_TRANSPARENT &&
                reaches_into(dvec3_length(dvec3_subtract(dvec3_of_vec4(a), dvec3_of_vec4(b))) - (double)b.w,
                             a))
                warn_overlap(packing, packing->sphere_sources[k], packing->sphere_sources[i]);
        }
        for (int k = 0; k < packed->plane_count; ++k)
            if (packed->planes[k].surface.tags.SURFACE_KIND == KIND_TRANSPARENT &&
                reaches_into(plane_height(&packed->planes[k], dvec3_of_vec4(a)), a))
                warn_overlap(packing, packing->plane_sources[k], packing->sphere_sources[i]);
    }
    for (int i = 0; i < packed->plane_count; ++i)
        for (int k = 0; k < i; ++k) {
            layout_vec4 a = packed->planes[i].normal_offset, b = packed->planes[k].normal_offset;
            bool apart = a.x == -b.x && a.y == -b.y && a.z == -b.z && a.w + b.w <= 0;
            if (!apart && packed->planes[i].surface.tags.SURFACE_KIND == KIND_TRANSPARENT &&
                packed->planes[k].surface.tags.SURFACE_KIND == KIND_TRANSPARENT)
                warn_overlap(packing, packing->plane_sources[k], packing->plane_sources[i]);
        }
}

/* Leaves the last matte surface's A and B, for scenes in which all are the same. */
static void share_roughness(struct packed_scene *packed, const PackedSurface *surface)
{
    if (surface->tags.SURFACE_KIND == KIND_MATTE)
        packed->view.matte =
            (layout_vec4){surface->parameters.OREN_NAYAR_A, surface->more_parameters.OREN_NAYAR_B, 0, 0};
}

static enum status pack_contents(struct packing *packing)
{
    const struct scene *scene = packing->scene;
    struct packed_scene *packed = packing->packed;
    pack_view(packing);
    for (size_t i = 0; i < scene->object_count; ++i) {
        if (scene->objects[i].type == OBJECT_SPHERE)
            pack_sphere(packing, &scene->objects[i]);
        else
            pack_plane(packing, &scene->objects[i]);
    }
    for (int i = 0; i < packed->sphere_count; ++i)
        share_roughness(packed, &packed->spheres[i].surface);
    for (int i = 0; i < packed->plane_count; ++i)
        share_roughness(packed, &packed->planes[i].surface);
    for (int i = 0; i < packed->plane_count; ++i)
        packed->planes[i].surface.tags.CASTS_SHADOWS =
            packed->planes[i].surface.tags.SURFACE_KIND == KIND_TRANSPARENT;
    for (size_t i = 0; i < scene->light_count; ++i) {
        const struct scene_light *light = &scene->lights[i];
        enum status status =
            light->type == LIGHT_POINT ? pack_point_light(packing, light) : pack_quad_light(packing, light);
        if (status != STATUS_DONE)
            return status;
    }
    for (int i = 0; i < packed->sphere_count; ++i) {
        packed->spheres[i].surface.tags.HOLDS_RAYS = holds_rays(packed, i);
        packed->spheres[i].surface.tags.HOLDS_LIGHTS = holds_lights(packed, &packed->spheres[i]);
    }
    return STATUS_DONE;
}

double pack_scale(const struct scene *scene)
{
    int exponent;
    frexp(scene_extent(scene), &exponent);
    return ldexp(1, -exponent);
}

enum status pack_scene(const struct scene *scene, const struct picture_settings *settings,
                       struct packed_scene *packed)
{
    struct packing packing = {.scene = scene, .scale = pack_scale(scene), .packed = packed};
    *packed = (struct packed_scene){
        .width = (int)settings->width,
        .height = (int)settings->height,
        .max_bounces = (int)settings->max_bounces,
        .samples = (int)settings->samples,
        .light_samples = (int)settings->light_samples,
        .spheres = calloc(scene->object_count + 1, sizeof *packed->spheres),
        .planes = calloc(scene->object_count + 1, sizeof *packed->planes),
        .point_lights = calloc(scene->light_count + 1, sizeof *packed->point_lights),
        .quad_lights = calloc(scene->light_count + 1, sizeof *packed->quad_lights),
    };
    packing.sphere_sources = calloc(scene->object_count + 1, sizeof *packing.sphere_sources);
    packing.plane_sources = calloc(scene->object_count + 1, sizeof *packing.plane_sources);
    enum status status = STATUS_UNABLE;
    if (packed->spheres && packed->planes && packed->point_lights && packed->quad_lights &&
        packing.sphere_sources && packing.plane_sources)
        status = pack_contents(&packing);
    else
        log_error("%s: no memory for %zu objects", scene->path, scene->object_count);
    if (status == STATUS_DONE)
        truncation_pack(packed, settings->has_max_error ? settings->max_error : -1);
    if (status == STATUS_DONE && !settings->warned)
        warn_of_overlaps(&packing);
    free(packing.sphere_sources);
    free(packing.plane_sources);
    if (status != STATUS_DONE)
        pack_destroy(packed);
    return status;
}

void pack_destroy(struct packed_scene *packed)
{
    free(packed->spheres);
    free(packed->planes);
    free(packed->point_lights);
    free(packed->quad_lights);
    *packed = (struct packed_scene){0};
}
