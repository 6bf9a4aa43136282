#include "scene/pack.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/body.h"
#include "scene/hollow.h"
#include "scene/looped.h"
#include "scene/truncation.h"
#include "scene/vector.h"

static const double pi = 3.14159265358979323846;

/* Keeps the largest possible radiance, at NEAREST_LIGHT_SQUARED, far inside float. */
static const double brightest = 1e12;

/* In scene units: its square, and what float leaves of it behind the point, is far from denormals. */
static const double least_radius = 0x1p-50;

/* Of the distance from the middle of the image plane to a corner, by that to the camera: its square is
 * finite. */
static const double widest = 0x1p60;

/* In scene units. A larger ball is stored as one of this radius, with the same surface at the origin: its
 * horizon, seen from height h, is lower by sqrt(2 h / r) or less, 2^-15.5 radians. Of still larger ones,
 * doubles would not tell on which side of the surface the camera is. */
static const double largest_radius = 0x1p32;

struct packing {
    const struct scene *scene;
    double scale; /* from metres to scene units, a power of two */
    struct looped looped;
    const struct packed_scene *other; /* whose hierarchy may be shared; may be NULL */
    int others_before;                /* spheres that are not looped over, before the body that is packed */
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

static PackedSurface pack_surface(const struct scene *scene, const struct scene_object *object, size_t order)
{
    const struct scene_material *material = &scene->materials[object->material];
    PackedSurface surface = {.tags.FILE_ORDER = (int)order};
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

/* Whether the packed body i is opaque and coincides with this one, which is then never met: ties go to the
 * first. */
static bool hides(const struct packed_scene *packed, int i, bool is_ball, layout_vec4 shape, float curvature)
{
    layout_vec4 first = body_shape(packed, i);
    return is_ball == (i < packed->sphere_count) && !is_transparent(body_surface(packed, i)) &&
           body_surface(packed, i)->more_parameters.CURVATURE == curvature && first.x == shape.x &&
           first.y == shape.y && first.z == shape.z && first.w == shape.w;
}

/* See scene_layout.h; the giant's lengths are in scene units. */
static layout_vec4 pack_giant(struct body giant, PackedSurface *surface)
{
    const double height = giant_height(giant), curvature = 1 / fmin(giant.number, largest_radius);
    surface->more_parameters.CURVATURE = to_float(curvature);
    return to_vec4(dvec3_scale(-(1 - curvature * height), dvec3_unit(giant.vector)),
                   height * (1 - curvature * height / 2));
}

/* A plane, or a sphere that is looped over. */
static void pack_body(struct packing *packing, size_t number)
{
    struct packed_scene *packed = packing->packed;
    struct body body = body_numbered(packing->scene, number);
    PackedSurface surface = pack_surface(packing->scene, body_find(packing->scene, number).object, number);
    surface.tags.OTHERS_BEFORE = packing->others_before;
    const bool giant = giant_is(packing->scene, body);
    bool turned = !body.is_ball && !is_transparent(&surface) &&
                  body_distance(body, dvec3_of(packing->scene->camera.position)) < 0;
    double sign = turned ? -1 : 1;
    body.vector = dvec3_scale(body.is_ball ? packing->scale : sign, body.vector);
    body.number = sign * packing->scale * body.number;
    const layout_vec4 shape = giant ? pack_giant(body, &surface) : to_vec4(body.vector, body.number);
    for (int i = 0; i < body_count(packed); ++i)
        if (hides(packed, i, body.is_ball, shape, surface.more_parameters.CURVATURE))
            return;
    surface.tags.CASTS_SHADOWS = !body.is_ball && is_transparent(&surface);
    if (body.is_ball) {
        packed->giants |= (unsigned)giant << packed->sphere_count;
        packed->spheres[packed->sphere_count++] =
            (struct PackedSphere){shape, {.SURFACE = packed->surface_count, .FILE_ORDER = (int)number}};
        packed->surfaces[packed->surface_count++] = surface;
        packed->looped_spheres = packed->sphere_count;
    } else
        packed->planes[packed->plane_count++] = (struct PackedPlane){shape, surface};
}

/* A sphere that is not looped over. */
static bool is_other(const struct packing *packing, size_t number)
{
    return body_numbered(packing->scene, number).is_ball && !is_looped(&packing->looped, number);
}

static void pack_planes_and_looped(struct packing *packing)
{
    for (size_t i = 0; i < packing->scene->body_count; ++i)
        if (is_other(packing, i))
            ++packing->others_before;
        else
            pack_body(packing, i);
}

/* Whether the spheres that are not looped over are the same. */
static bool same_others(const struct packed_scene *a, const struct packed_scene *b)
{
    bool same = a->sphere_count == b->sphere_count && a->looped_spheres == b->looped_spheres;
    for (int i = a->looped_spheres; i < a->sphere_count && same; ++i)
        same = memcmp(&a->spheres[i].center_radius, &b->spheres[i].center_radius, sizeof(layout_vec4)) == 0;
    return same;
}

static enum status find_hierarchy(struct packing *packing)
{
    struct packed_scene *packed = packing->packed;
    if (packing->other && packing->other->hierarchy && same_others(packing->other, packed)) {
        packed->hierarchy = packing->other->hierarchy;
        ++packed->hierarchy->owners;
        return STATUS_DONE;
    }
    struct hierarchy *hierarchy = calloc(1, sizeof *hierarchy);
    if (!hierarchy) {
        log_error("%s: no memory for a hierarchy", packing->scene->path);
        return STATUS_UNABLE;
    }
    enum status status =
        hierarchy_build(packed->spheres, (uint32_t)packed->looped_spheres,
                        (uint32_t)(packed->sphere_count - packed->looped_spheres), hierarchy);
    hierarchy->owners = 1;
    packed->hierarchy = hierarchy;
    return status;
}

/* They share their object's surface. */
static enum status pack_others(struct packing *packing)
{
    const struct scene *scene = packing->scene;
    struct packed_scene *packed = packing->packed;
    const struct scene_object *object = NULL;
    for (size_t i = 0; i < scene->body_count; ++i) {
        if (!is_other(packing, i))
            continue;
        const struct body body = body_numbered(scene, i);
        if (body_find(scene, i).object != object) {
            object = body_find(scene, i).object;
            packed->surfaces[packed->surface_count++] = pack_surface(scene, object, object->first);
        }
        packed->spheres[packed->sphere_count++] = (struct PackedSphere){
            to_vec4(dvec3_scale(packing->scale, body.vector), packing->scale * body.number),
            {.SURFACE = packed->surface_count - 1, .FILE_ORDER = (int)i}};
    }
    return packed->sphere_count == packed->looped_spheres ? STATUS_DONE : find_hierarchy(packing);
}

static bool lies_behind(const struct packed_scene *packed, int plane, struct dvec3 point)
{
    const struct body body = body_packed(packed, packed->sphere_count + plane);
    return body_distance(body, point) < -RESOLUTION * (dvec3_length(point) + fabs(body.number));
}

static void pack_point_light(struct packing *packing, const struct scene_light *light, struct dvec3 intensity)
{
    struct packed_scene *packed = packing->packed;
    struct dvec3 position = dvec3_scale(packing->scale, dvec3_of(light->point.position));
    for (int i = 0; i < packed->plane_count; ++i)
        if (!is_transparent(&packed->planes[i].surface) && lies_behind(packed, i, position))
            return; /* behind an opaque plane: it lights nothing that can be seen */
    packed->point_lights[packed->point_light_count++] = (struct PackedPointLight){
        .position = to_vec4(position, 0),
        .intensity = to_vec4(intensity, 0),
    };
}

static void pack_quad_light(struct packing *packing, const struct scene_light *light, struct dvec3 radiance)
{
    struct packed_scene *packed = packing->packed;
    struct dvec3 corner = dvec3_scale(packing->scale, dvec3_of(light->quad.corner));
    struct dvec3 u = dvec3_scale(packing->scale, dvec3_of(light->quad.u));
    struct dvec3 v = dvec3_scale(packing->scale, dvec3_of(light->quad.v));
    for (int i = 0; i < packed->plane_count; ++i)
        for (int k = 0; k < 4; ++k)
            if (lies_behind(packed, i, dvec3_corner(corner, u, v, k)))
                packed->planes[i].surface.tags.CASTS_SHADOWS = 1;
    packed->quad_lights[packed->quad_light_count++] = (struct PackedQuadLight){
        .corner = to_vec4(corner, 0),
        .edge_u = to_vec4(u, 0),
        .edge_v = to_vec4(v, 0),
        .area_normal = to_vec4(dvec3_cross(u, v), 0),
        .radiance = to_vec4(dvec3_scale(1.0 / packed->light_samples, radiance), 0),
    };
}

static enum status pack_light(struct packing *packing, const struct scene_light *light)
{
    bool point = light->type == LIGHT_POINT;
    double power = point ? light->power * packing->scale * packing->scale : light->power;
    struct dvec3 colored_power = dvec3_scale(power, dvec3_of(light->color));
    if (dvec3_largest(colored_power) > brightest) {
        log_error("%s:%d:%d: %s light: color times power must be at most %g%s", packing->scene->path,
                  light->place.line, light->place.column, point ? "point" : "quad", brightest,
                  point ? " times the square of the scene's extent" : "");
        return STATUS_REFUSED;
    }
    (point ? pack_point_light : pack_quad_light)(packing, light, colored_power);
    return STATUS_DONE;
}

/* The last one's, to be used where all are the same. */
static void share_roughness(struct packed_scene *packed)
{
    for (int i = 0; i < packed_surface_count(packed); ++i) {
        const PackedSurface *surface = packed_surface(packed, i);
        if (surface->tags.SURFACE_KIND == KIND_MATTE)
            packed->view.matte = (layout_vec4){.SHARED_A = surface->parameters.OREN_NAYAR_A,
                                               .SHARED_B = surface->more_parameters.OREN_NAYAR_B};
    }
}

/* Whether float's exponents suffice for the body. */
static bool is_large_enough(const struct packing *packing, size_t number)
{
    const struct body_place place = body_find(packing->scene, number);
    const struct body body = body_numbered(packing->scene, number);
    char name[BODY_NAME];
    if (!body.is_ball || body.number * packing->scale >= least_radius)
        return true;
    log_error("%s:%d:%d: sphere %s: radius must be at least %g of the scene's extent, %.3g, is %g",
              packing->scene->path, place.object->place.line, place.object->place.column,
              body_name(place, name), least_radius, least_radius / packing->scale, body.number);
    return false;
}

static enum status check_ranges(const struct packing *packing)
{
    const struct scene *scene = packing->scene;
    const struct packed_scene *packed = packing->packed;
    const double half = tan(scene->camera.fov_y_degrees / 180 * pi / 2);
    for (size_t i = 0; i < scene->body_count; ++i)
        if (!is_large_enough(packing, i))
            return STATUS_REFUSED;
    if (half * (1 + (double)packed->width / packed->height) < widest)
        return STATUS_DONE;
    log_error("%s: fov_y %.17g is too near to 180 degrees for a picture of %dx%d", scene->path,
              scene->camera.fov_y_degrees, packed->width, packed->height);
    return STATUS_REFUSED;
}

static enum status pack_contents(struct packing *packing)
{
    const struct scene *scene = packing->scene;
    enum status status = check_ranges(packing);
    if (status != STATUS_DONE)
        return status;
    pack_view(packing);
    pack_planes_and_looped(packing);
    status = pack_others(packing);
    for (size_t i = 0; i < scene->light_count && status == STATUS_DONE; ++i)
        status = pack_light(packing, &scene->lights[i]);
    if (status != STATUS_DONE)
        return status;
    hollow_pack(packing->packed);
    share_roughness(packing->packed);
    return STATUS_DONE;
}

static double extent_of(const struct scene *scene, struct body body)
{
    if (giant_is(scene, body))
        return fabs(giant_height(body));
    return body.is_ball ? dvec3_largest(body.vector) + body.number : fabs(body.number);
}

double pack_scale(const struct scene *scene)
{
    double extent = dvec3_largest(dvec3_of(scene->camera.position));
    for (size_t i = 0; i < scene->body_count; ++i)
        extent = fmax(extent, extent_of(scene, body_numbered(scene, i)));
    for (size_t i = 0; i < scene->light_count; ++i) {
        const struct scene_light *light = &scene->lights[i];
        if (light->type == LIGHT_POINT)
            extent = fmax(extent, dvec3_largest(dvec3_of(light->point.position)));
        for (int k = 0; k < 4 && light->type == LIGHT_QUAD; ++k)
            extent =
                fmax(extent, dvec3_largest(dvec3_corner(dvec3_of(light->quad.corner), dvec3_of(light->quad.u),
                                                        dvec3_of(light->quad.v), k)));
    }
    int exponent;
    frexp(extent, &exponent);
    return ldexp(1, -exponent);
}

enum status pack_scene(const struct packed_scene *other, const struct scene *scene,
                       const struct picture_settings *settings, struct packed_scene *packed)
{
    const struct looped looped = looped_choose(scene);
    *packed = (struct packed_scene){
        .width = (int)settings->width,
        .height = (int)settings->height,
        .max_bounces = (int)settings->max_bounces,
        .samples = (int)settings->samples,
        .light_samples = (int)settings->light_samples,
        .spheres = calloc(looped.sphere_count + 1, sizeof *packed->spheres),
        .surfaces = calloc(scene->object_count + MOST_LOOPED, sizeof *packed->surfaces),
        .planes = calloc(scene->object_count + 1, sizeof *packed->planes),
        .point_lights = calloc(scene->light_count + 1, sizeof *packed->point_lights),
        .quad_lights = calloc(scene->light_count + 1, sizeof *packed->quad_lights),
    };
    struct packing packing = {
        .scene = scene, .scale = pack_scale(scene), .looped = looped, .other = other, .packed = packed};
    enum status status = STATUS_UNABLE;
    if (packed->spheres && packed->surfaces && packed->planes && packed->point_lights && packed->quad_lights)
        status = pack_contents(&packing);
    else
        log_error("%s: no memory for %zu objects and %zu spheres", scene->path, scene->object_count,
                  looped.sphere_count);
    if (status == STATUS_DONE)
        truncation_pack(packed, settings->has_max_error ? settings->max_error : -1);
    else
        pack_destroy(packed);
    return status;
}

void pack_destroy(struct packed_scene *packed)
{
    free(packed->spheres);
    free(packed->surfaces);
    if (packed->hierarchy && --packed->hierarchy->owners == 0) {
        hierarchy_destroy(packed->hierarchy);
        free(packed->hierarchy);
    }
    free(packed->planes);
    free(packed->point_lights);
    free(packed->quad_lights);
    *packed = (struct packed_scene){0};
}
