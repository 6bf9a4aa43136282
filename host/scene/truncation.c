#include "scene/truncation.h"

#include <math.h>

#include "scene/body.h"

/* A smaller allowance would not pay, and the tracers would meet denormals. */
static const double least_allowance = 0x1p-60;

/* How readily an allowance is spent; chosen by measurement, see NUMERICS.md. */
static const double spending = 3.2;

/* More than a light of this scene can give, should no better bound be found. */
static const float unbounded = (float)UNBOUNDED;

/* Added to the bound, so that it is not 0. */
static const double darkest = 0x1p-30f;

/* Where float puts a point of a surface, off by less than this, in scene units. */
static const double accuracy = 0x1p-20;

/* Stands for all relative rounding errors on the way of a ray: 6 bits more than a bounce loses, as products
 * of weights lose that much in 1000 bounces. */
static const double slack = 0x1p-10;

/* Bodies for which other threads pay. */
static const int least_parallel = 4096;

static struct dvec3 quad_corner(const struct PackedQuadLight *quad, int number)
{
    return dvec3_corner(dvec3_of_vec4(quad->corner), dvec3_of_vec4(quad->edge_u), dvec3_of_vec4(quad->edge_v),
                        number);
}

static double distance_from_segment(struct dvec3 from, struct dvec3 edge, struct dvec3 point)
{
    double along = dvec3_dot(dvec3_subtract(point, from), edge) / dvec3_dot(edge, edge);
    struct dvec3 nearest = dvec3_add(from, dvec3_scale(fmin(1, fmax(0, along)), edge));
    return dvec3_distance(point, nearest);
}

static double distance_from_quad(const struct PackedQuadLight *quad, struct dvec3 point)
{
    struct dvec3 u = dvec3_of_vec4(quad->edge_u), v = dvec3_of_vec4(quad->edge_v), normal = dvec3_cross(u, v);
    struct dvec3 way = dvec3_subtract(point, quad_corner(quad, 0));
    double area_squared = dvec3_dot(normal, normal);
    double at_u = dvec3_dot(dvec3_cross(way, v), normal) / area_squared;
    double at_v = dvec3_dot(dvec3_cross(u, way), normal) / area_squared;
    if (at_u >= 0 && at_u <= 1 && at_v >= 0 && at_v <= 1)
        return fabs(dvec3_dot(way, normal)) / sqrt(area_squared);
    double nearest = INFINITY;
    for (int i = 0; i < 2; ++i) {
        nearest = fmin(nearest, distance_from_segment(quad_corner(quad, 2 * i), u, point));
        nearest = fmin(nearest, distance_from_segment(quad_corner(quad, i), v, point));
    }
    return nearest;
}

/* Between the body's surface and the quad; 0 where they meet. */
static double quad_distance(struct body body, const struct PackedQuadLight *quad)
{
    double nearest = INFINITY, farthest = -INFINITY;
    for (int i = 0; i < 4; ++i) {
        double distance = body_distance(body, quad_corner(quad, i));
        nearest = fmin(nearest, distance);
        farthest = fmax(farthest, distance);
    }
    if (body.is_ball) /* all corners in it: the quad is; but corners outside tell little */
        nearest = distance_from_quad(quad, body.vector) - body.number;
    return fmax(0, fmax(nearest, -farthest));
}

static double inverse_square(double distance)
{
    double least = distance * (1 - slack) - accuracy;
    return least > 0 ? 1 / (least * least) : INFINITY;
}

/* The body's largest radiance. Oren-Nayar's A cos_in + B cos_in s / max(cos_in, cos_out), where s is at most
 * sin_in, is at most A cos_in + B sin_in. */
static double matte_radiance(const struct packed_scene *scene, int index)
{
    const PackedSurface *surface = body_surface(scene, index);
    if (surface->tags.SURFACE_KIND != KIND_MATTE)
        return 0;
    const struct body body = body_packed(scene, index);
    struct dvec3 irradiance = {0, 0, 0};
    for (int i = 0; i < scene->point_light_count; ++i) {
        const struct PackedPointLight *light = &scene->point_lights[i];
        double falloff = inverse_square(fabs(body_distance(body, dvec3_of_vec4(light->position))));
        irradiance = dvec3_add(irradiance, dvec3_scale(falloff, dvec3_of_vec4(light->intensity)));
    }
    for (int i = 0; i < scene->quad_light_count; ++i) {
        const struct PackedQuadLight *light = &scene->quad_lights[i];
        double area = dvec3_length(dvec3_of_vec4(light->area_normal)) * scene->light_samples;
        double falloff = inverse_square(quad_distance(body, light));
        irradiance = dvec3_add(irradiance, dvec3_scale(area * falloff, dvec3_of_vec4(light->radiance)));
    }
    struct dvec3 albedo = dvec3_of_vec4(surface->parameters);
    double largest = fmax(albedo.x * irradiance.x, fmax(albedo.y * irradiance.y, albedo.z * irradiance.z));
    if (!isfinite(largest)) /* also 0 times INFINITY */
        return INFINITY;
    return largest *
           hypot((double)surface->parameters.OREN_NAYAR_A, (double)surface->more_parameters.OREN_NAYAR_B);
}

/* Radiance that no ray of the scene brings more of, in any channel; INFINITY where there is no bound, because
 * a light touches a matte surface. Holds for what float computes, not only for exact arithmetic. */
static double largest_radiance(const struct packed_scene *scene)
{
    double radiance = dvec3_largest(dvec3_of_vec4(scene->view.background));
#pragma omp parallel for reduction(max : radiance) if (body_count(scene) > least_parallel)
    for (int i = 0; i < body_count(scene); ++i)
        radiance = fmax(radiance, matte_radiance(scene, i));
    return radiance * (1 + slack);
}

/* What two pictures that trace some of the same rays may differ by through rounding alone: each sample's sum,
 * exact but for its last rounding and for 2^-48 (rays)^2, up to 4000 rays, the sum over the samples, and the
 * division. */
static double rounding(const struct packed_scene *scene, double radiance)
{
    double roundings = scene->samples > 1 ? 2.0 * scene->samples + 5 : 3;
    return roundings * 0x1p-24 * radiance;
}

/* The normal of two parallel mirrors that face each other, with w = 1, if every other plane is matte and
 * stands across them; otherwise 0. So it is where there are giants, or spheres that are not looped over:
 * whether a ray escapes is found out by trying all spheres, not only those on its way. */
static layout_vec4 between_mirrors(const struct packed_scene *scene)
{
    const layout_vec4 none = {0, 0, 0, 0};
    int mirror = 0;
    if (scene->sphere_count > scene->looped_spheres || scene->giants != 0)
        return none;
    while (mirror < scene->plane_count && scene->planes[mirror].surface.tags.SURFACE_KIND != KIND_MIRROR)
        ++mirror;
    if (mirror == scene->plane_count)
        return none;
    layout_vec4 normal = scene->planes[mirror].normal_offset;
    normal.w = 0;
    for (int i = 0; i < scene->plane_count; ++i) {
        layout_vec4 other = scene->planes[i].normal_offset;
        int kind = scene->planes[i].surface.tags.SURFACE_KIND;
        double cosine = dvec3_dot(dvec3_of_vec4(normal), dvec3_of_vec4(other));
        bool parallel = other.x == normal.x && other.y == normal.y && other.z == normal.z;
        bool faces = other.x == -normal.x && other.y == -normal.y && other.z == -normal.z;
        if (kind == KIND_MIRROR ? !parallel && !faces : kind == KIND_TRANSPARENT || fabs(cosine) > accuracy)
            return none;
        if (kind == KIND_MIRROR && faces)
            normal.w = 1;
    }
    return normal.w > 0 ? normal : none;
}

void truncation_pack(struct packed_scene *scene, double max_error)
{
    double radiance = largest_radiance(scene);
    bool bounded = radiance < (double)unbounded;
    double bound = bounded ? radiance * (1 + slack) + darkest : (double)unbounded;
    double allowance = (max_error * (1 - slack) - rounding(scene, radiance)) / bound;
    if (max_error >= 0)
        scene->view.between_mirrors = between_mirrors(scene);
    scene->view.truncation = (layout_vec4){.RADIANCE_BOUND = (float)bound, .ALLOWANCE = -1};
    if (bounded && allowance > least_allowance) {
        scene->view.truncation.ALLOWANCE = (float)allowance;
        scene->view.truncation.SPENDING = (float)(spending / allowance);
    }
}

double truncation_bound(const struct packed_scene *scene, double charges)
{
    if (charges == 0)
        return 0;
    if (scene->view.truncation.RADIANCE_BOUND == unbounded || isnan(charges))
        return INFINITY;
    double bound = (double)scene->view.truncation.RADIANCE_BOUND;
    return charges * bound / scene->samples * (1 + slack) + rounding(scene, bound);
}
