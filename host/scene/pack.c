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
        if (light->type == LIGHT_POINT)
            extent = fmax(extent, dvec3_largest(dvec3_of(light->point.position)));
        for (int k = 0; k < 4 && light->type == LIGHT_QUAD; ++k)
            extent =
                fmax(extent, dvec3_largest(dvec3_corner(dvec3_of(light->quad.corner), dvec3_of(light->quad.u),
                                                        dvec3_of(light->quad.v), k)));
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
    double sigma_squared = material->roughness * material->roughness, ior = material->ior;
    switch (material->type) {
    case MATERIAL_MATTE:
        surface.tags.SURFACE_KIND = KIND_MATTE;
        surface.parameters = to_vec4(dvec3_scale(1 / pi, dvec3_of(material->color)), 0);
        surface.parameters.OREN_NAYAR_A = to_float(1 - 0.5 * sigma_squared / (sigma_squared + 0.33));
        surface.more_parameters.OREN_NAYAR_B = to_float(0.45 * sigma_squared / (sigma_squared + 0.09));
        break;
    case MATERIAL_MIRROR:
        surface.tags.SURFACE_KIND = KIND_MIRROR;
        break;
    case MATERIAL_TRANSPARENT:
        surface.tags.SURFACE_KIND = KIND_TRANSPARENT;
        surface.parameters.ETA_ENTERING = to_float(1 / ior);
        surface.parameters.KAPPA_ENTERING = to_float((ior - 1) * (ior + 1) / (ior * ior));
        surface.parameters.ETA_EXITING = to_float(ior);
        surface.parameters.KAPPA_EXITING = to_float((1 - ior) * (1 + ior));
        break;
    }
    return surface;
}

static bool is_transparent(const PackedSurface *surface)
{
    return surface->tags.SURFACE_KIND == KIND_TRANSPARENT;
}

static bool same_vec4(layout_vec4 a, layout_vec4 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

/* An object that coincides with an opaque one before it is never met: ties go to the first. */
static void pack_sphere(struct packing *packing, const struct scene_object *object)
{
    struct packed_scene *packed = packing->packed;
    const struct PackedSphere sphere = {
        .center_radius = to_vec4(dvec3_scale(packing->scale, dvec3_of(object->sphere.center)),
                                 packing->scale * object->sphere.radius),
        .surface = pack_surface(packing->scene, object),
    };
    for (int i = 0; i < packed->sphere_count; ++i)
        if (same_vec4(packed->spheres[i].center_radius, sphere.center_radius) &&
            !is_transparent(&packed->spheres[i].surface))
            return;
    packed->spheres[packed->sphere_count++] = sphere;
}

static void pack_plane(struct packing *packing, const struct scene_object *object)
{
    struct packed_scene *packed = packing->packed;
    struct dvec3 normal, camera = dvec3_scale(packing->scale, dvec3_of(packing->scene->camera.position));
    double offset = packing->scale * plane_offset(object, &normal);
    struct PackedPlane plane = {.surface = pack_surface(packing->scene, object)};
    plane.surface.tags.CASTS_SHADOWS = is_transparent(&plane.surface);
    bool turned = !is_transparent(&plane.surface) && dvec3_dot(normal, camera) < offset;
    plane.normal_offset = turned ? to_vec4(dvec3_scale(-1, normal), -offset) : to_vec4(normal, offset);
    for (int i = 0; i < packed->plane_count; ++i)
        if (same_vec4(packed->planes[i].normal_offset, plane.normal_offset) &&
            !is_transparent(&packed->planes[i].surface))
            return;
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
    struct dvec3 position = dvec3_scale(packing->scale, dvec3_of(light->point.position));
    struct dvec3 intensity =
        dvec3_scale(light->power * packing->scale * packing->scale, dvec3_of(light->color));
    if (dvec3_largest(intensity) > brightest) {
        log_error("%s:%d:%d: point light: color times power must be at most %g times the square of the "
                  "scene's extent",
                  packing->scene->path, light->place.line, light->place.column, brightest);
        return STATUS_REFUSED;
    }
    for (int i = 0; i < packed->plane_count; ++i)
        if (!is_transparent(&packed->planes[i].surface) && lies_behind(&packed->planes[i], position))
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
    struct dvec3 radiance = dvec3_scale(light->power, dvec3_of(light->color));
    if (dvec3_largest(radiance) > brightest) {
        log_error("%s:%d:%d: quad light: color times power must be at most %g", packing->scene->path,
                  light->place.line, light->place.column, brightest);
        return STATUS_REFUSED;
    }
    for (int i = 0; i < packed->plane_count; ++i)
        for (int k = 0; k < 4; ++k)
            if (lies_behind(&packed->planes[i], dvec3_corner(corner, u, v, k)))
                packed->planes[i].surface.tags.CASTS_SHADOWS = 1;
    packed->quad_lights[packed->quad_light_count++] = (struct PackedQuadLight){
        .corner = to_vec4(corner, 0),
        .edge_u = to_vec4(u, 0),
        .edge_v = to_vec4(v, 0),
        .area_normal = to_vec4(dvec3_cross(u, v), 0),
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
    if (dvec3_distance(dvec3_of_vec4(packed->view.position), center) < radius)
        return true;
    if (!is_transparent(&holder->surface))
        return false;
    for (int i = 0; i < packed->plane_count; ++i)
        if (reaches_into(fabs(plane_height(&packed->planes[i], center)), holder->center_radius))
            return true;
    for (int i = 0; i < packed->sphere_count; ++i) {
        layout_vec4 other = packed->spheres[i].center_radius;
        double apart = dvec3_distance(dvec3_of_vec4(other), center);
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
        if (dvec3_distance(light, center) < radius)
            return true;
    }
    for (int i = 0; i < packed->quad_light_count; ++i) {
        const struct PackedQuadLight *quad = &packed->quad_lights[i];
        struct dvec3 u = dvec3_of_vec4(quad->edge_u), v = dvec3_of_vec4(quad->edge_v);
        struct dvec3 middle = dvec3_add(dvec3_of_vec4(quad->corner), dvec3_scale(0.5, dvec3_add(u, v)));
        double reach = (dvec3_length(u) + dvec3_length(v)) / 2;
        if (dvec3_distance(middle, center) < radius + reach)
            return true;
    }
    return false;
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
    struct packing packing = {.scene = scene, .scale = pack_scale(scene), .packed = packed};
    enum status status = STATUS_UNABLE;
    if (packed->spheres && packed->planes && packed->point_lights && packed->quad_lights)
        status = pack_contents(&packing);
    else
        log_error("%s: no memory for %zu objects", scene->path, scene->object_count);
    if (status == STATUS_DONE)
        truncation_pack(packed, settings->has_max_error ? settings->max_error : -1);
    else
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
