#include "oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>

namespace
{

using Body = OracleBody;

struct Ray {
    Vector origin, direction; /* of any length */
    const Body *leaves;       /* whose surface the origin is on; NULL: the camera's */
    bool inward;              /* into that body */
    uint32_t branch; /* in the binary tree that glass makes: the children of i are 2 i + 1 refracted and 2 i +
                      * 2 reflected */
    int bounces;
    Ball weight; /* its share in the pixel */
};

/* How far along a ray, in its direction's length, as a fraction with a positive denominator: planes are met
 * at exactly the same distance by some of the figures' rays, which no rounded quotient hides. */
struct Distance {
    bool met = false;
    Ball numerator = 0, denominator = 1;
};

struct Hit {
    const Body *body;
    Vector point,
        normal; /* the normal against the ray; a plane's as it is packed, of length 1 but for rounding */
    bool from_inside;
};

struct Scene {
    const packed_scene &packed;
    const std::vector<Body> &bodies;
    uint32_t pixel_seed;
    int &ties;
};

Vector vector_of(const layout_vec4 &v)
{
    return {v.x, v.y, v.z};
}

/* A giant is the sphere where gradient . x + curvature / 2 |x|^2 = offset. */
Vector center_of(const Body &sphere)
{
    return sphere.curvature != 0 ? -1.0 / Ball(sphere.curvature) * sphere.vector : sphere.vector;
}

Ball squared_radius_of(const Body &sphere)
{
    if (sphere.curvature == 0)
        return sphere.number * sphere.number;
    const Vector center = center_of(sphere);
    return dot(center, center) + 2.0 * sphere.number / sphere.curvature;
}

/* An opaque plane's normal points to the side where all rays stay, also those that start on it. */
Distance meet_plane(const Ray &ray, const Body &plane)
{
    const Ball slope = dot(plane.vector, ray.direction);
    const Ball height = dot(plane.vector, ray.origin) - plane.number;
    const bool opaque = plane.surface->tags.SURFACE_KIND != KIND_TRANSPARENT;
    if (negative(slope) && (opaque || positive(height)))
        return {true, height, -slope};
    if (!opaque && negative(height) && positive(slope))
        return {true, -height, slope};
    return {};
}

/* The roots of a t^2 + 2 b t + c, by the sign of c: 0 on the surface, below it inside. */
Distance meet_sphere(const Ray &ray, const Body &sphere)
{
    const Vector from_center = ray.origin - center_of(sphere);
    const Ball a = dot(ray.direction, ray.direction), b = dot(from_center, ray.direction);
    if (ray.leaves == &sphere)
        return {ray.inward, -2.0 * b, a};
    const Ball c = dot(from_center, from_center) - squared_radius_of(sphere);
    const bool inside = negative(c), outside = !inside && positive(c);
    if (!inside && !negative(b))
        return {};
    if (!inside && !outside)
        return {true, -2.0 * b, a};
    const Ball discriminant = b * b - a * c;
    if (outside && !positive(discriminant))
        return {};
    const Ball root = square_root(discriminant);
    return {true, inside ? root - b : -b - root, a};
}

Hit nearest_hit(const Scene &scene, const Ray &ray)
{
    const Body *body = nullptr;
    Distance nearest;
    for (const Body &candidate : scene.bodies) {
        if (&candidate == ray.leaves && !candidate.is_sphere)
            continue;
        Distance distance = candidate.is_sphere ? meet_sphere(ray, candidate) : meet_plane(ray, candidate);
        if (!distance.met)
            continue;
        if (body) {
            const Ball nearer =
                nearest.numerator * distance.denominator - distance.numerator * nearest.denominator;
            scene.ties += nearer.is_zero();
            if (!positive(nearer))
                continue;
        }
        nearest = distance;
        body = &candidate;
    }
    if (!body)
        return {};
    const Ball t = nearest.numerator / nearest.denominator;
    const Ball farthest = FARTHEST_HIT;
    if (positive(t * t * dot(ray.direction, ray.direction) - farthest * farthest))
        return {};
    const Vector point = ray.origin + t * ray.direction;
    const Vector normal = body->is_sphere ? unit(point - center_of(*body)) : body->vector;
    const bool from_inside = positive(dot(normal, ray.direction));
    return {body, point, from_inside ? -1.0 * normal : normal, from_inside};
}

/* Whether the body stands between the point that was hit and a point of a light, on the normal's side. */
bool blocks(const Body &body, const Hit &hit, const Vector &light)
{
    const Vector way = light - hit.point;
    if (!body.is_sphere) {
        if (&body == hit.body || !body.casts_shadows)
            return false;
        return negative((dot(body.vector, hit.point) - body.number) *
                        (dot(body.vector, light) - body.number));
    }
    const Vector center = center_of(body), from_center = hit.point - center,
                 light_from_center = light - center;
    const Ball squared_radius = squared_radius_of(body);
    const bool light_inside = negative(dot(light_from_center, light_from_center) - squared_radius);
    if (&body == hit.body)
        return hit.from_inside && !light_inside;
    const Ball c = dot(from_center, from_center) - squared_radius;
    if (negative(c) || light_inside)
        return !(negative(c) && light_inside);
    /* Both ends are outside: the line must pass through the ball, nearest to its centre in between. */
    const Ball a = dot(way, way), b = dot(from_center, way);
    return negative(b) && negative(-b - a) && positive(b * b - a * c);
}

/* How high the point is above the surface's tangent plane at the hit, on the normal's side. Where the surface
 * is a plane, that is exact. */
Ball height_above(const Hit &hit, const Vector &point)
{
    if (hit.body->is_sphere)
        return dot(hit.normal, point - hit.point);
    const Ball height = dot(hit.body->vector, point) - hit.body->number;
    return hit.from_inside ? -height : height;
}

/* The light from a point that sends this intensity, or where it is a point of an area, this radiance through
 * the area and its normal's direction. */
Vector light_from(const Scene &scene, const Ray &ray, const Hit &hit, const Vector &point,
                  const Vector &intensity, const Vector *area_normal)
{
    const Vector way = point - hit.point;
    const Ball squared_distance = dot(way, way), height = height_above(hit, point);
    if (negative(squared_distance - NEAREST_LIGHT_SQUARED) || !positive(height))
        return {};
    const Ball through_area = area_normal ? dot(*area_normal, way) : Ball(1);
    if (area_normal && !positive(through_area))
        return {};
    for (const Body &body : scene.bodies)
        if (blocks(body, hit, point))
            return {};

    /* Oren and Nayar's model without angles. */
    const PackedSurface &surface = *hit.body->surface;
    const Vector to_light = unit(way), to_viewer = -1.0 * unit(ray.direction);
    const Ball cos_light = height / length(way), cos_viewer = dot(hit.normal, to_viewer);
    const Ball azimuths = dot(to_light, to_viewer) - cos_light * cos_viewer;
    const Ball rough = larger(azimuths, 0) / larger(cos_light, cos_viewer);
    const Ball reflected = surface.parameters.OREN_NAYAR_A + surface.more_parameters.OREN_NAYAR_B * rough;
    const Ball received = cos_light / squared_distance * (area_normal ? through_area / length(way) : Ball(1));
    return received * reflected * product(vector_of(surface.parameters), intensity);
}

/* The points of quad lights: integers, as shaders/sampling.glsl defines them. */
uint32_t hash(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

uint32_t reverse(uint32_t x)
{
    uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit)
        reversed |= (x >> bit & 1) << (31 - bit);
    return reversed;
}

uint32_t scramble(uint32_t reversed, uint32_t seed)
{
    reversed ^= reversed * 0x3d20adeau;
    reversed = (reversed + seed) * (seed >> 16 | 1);
    reversed ^= reversed * 0x05526c56u;
    reversed ^= reversed * 0x53a22864u;
    return reverse(reversed);
}

double fraction(uint32_t bits)
{
    return (bits >> 8) * 0x1p-24;
}

/* By the direction numbers of Sobol's second dimension: each is the one before, xor its half. */
uint32_t second_dimension(uint32_t index)
{
    uint32_t point = 0;
    for (uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
        point ^= index & 1 ? direction : 0;
    return point;
}

Vector point_on(const PackedQuadLight &light, uint32_t seed, uint32_t index)
{
    const uint32_t shuffle = hash(seed);
    const double u = fraction(scramble(index, hash(shuffle + 1)));
    const double v = fraction(scramble(reverse(second_dimension(index)), hash(shuffle + 2)));
    return vector_of(light.corner) + Ball(u) * vector_of(light.edge_u) + Ball(v) * vector_of(light.edge_v);
}

Vector direct_light(const Scene &scene, const Ray &ray, const Hit &hit)
{
    const packed_scene &packed = scene.packed;
    const uint32_t seed = hash(scene.pixel_seed + ray.branch * (uint32_t)packed.quad_light_count);
    Vector sum;
    for (int i = 0; i < packed.point_light_count; ++i) {
        const PackedPointLight &light = packed.point_lights[i];
        sum =
            sum + light_from(scene, ray, hit, vector_of(light.position), vector_of(light.intensity), nullptr);
    }
    for (int i = 0; i < packed.quad_light_count; ++i) {
        const PackedQuadLight &light = packed.quad_lights[i];
        const Vector area_normal = vector_of(light.area_normal);
        uint32_t first = scramble(0, hash(seed + (uint32_t)i)); /* of a block of at least so many points */
        for (int size = 1; size < packed.light_samples; size *= 2)
            first *= 2;
        for (int k = 0; k < packed.light_samples; ++k) {
            const Vector point = point_on(light, seed + (uint32_t)i, first + (uint32_t)k);
            sum = sum + light_from(scene, ray, hit, point, vector_of(light.radiance), &area_normal);
        }
    }
    return sum;
}

Vector radiance(const Scene &scene, const Ray &ray);

/* A ray of that share in this one's. */
Vector continue_with(const Scene &scene, const Ray &ray, const Hit &hit, const Vector &direction, bool inward,
                     uint32_t branch, const Ball &share)
{
    const Ball weight = ray.weight * share;
    if (ray.bounces == scene.packed.max_bounces || negative(weight - SMALLEST_WEIGHT))
        return {};
    return share * radiance(scene, {hit.point, direction, hit.body, inward, branch, ray.bounces + 1, weight});
}

Vector reflect(const Scene &scene, const Ray &ray, const Hit &hit, uint32_t branch, const Ball &share)
{
    const Vector direction = unit(ray.direction - 2.0 * dot(ray.direction, hit.normal) * hit.normal);
    return continue_with(scene, ray, hit, direction, hit.from_inside, branch, share);
}

/* Snell and Descartes, Fresnel: eta = n1 / n2, and kappa = 1 - eta^2. Both are rounded, and the latter takes
 * part as it is, in cos_out alone: in Fresnel's second equation the product of the sines is eta sin_in^2. */
Vector split(const Scene &scene, const Ray &ray, const Hit &hit)
{
    const layout_vec4 &glass = hit.body->surface->parameters;
    const Ball eta = hit.from_inside ? glass.ETA_EXITING : glass.ETA_ENTERING;
    const Ball kappa = hit.from_inside ? glass.KAPPA_EXITING : glass.KAPPA_ENTERING;
    const Vector incident = unit(ray.direction);
    const Ball cos_in = -dot(incident, hit.normal);
    const Ball squared_cos_out = kappa + eta * eta * cos_in * cos_in;
    if (!positive(squared_cos_out))
        return reflect(scene, ray, hit, ray.branch, 1);
    const Ball cos_out = square_root(squared_cos_out);
    const Ball perpendicular = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
    const Ball cosines = cos_in * cos_out, sines = eta * (1.0 - cos_in * cos_in);
    const Ball parallel = perpendicular * (cosines - sines) / (cosines + sines);
    const Ball k_r = (perpendicular * perpendicular + parallel * parallel) / 2.0;
    const Vector refracted = eta * incident + (eta * cos_in - cos_out) * hit.normal;
    return reflect(scene, ray, hit, 2 * ray.branch + 2, k_r) +
           continue_with(scene, ray, hit, refracted, !hit.from_inside, 2 * ray.branch + 1, 1.0 - k_r);
}

Vector radiance(const Scene &scene, const Ray &ray)
{
    const Hit hit = nearest_hit(scene, ray);
    if (!hit.body)
        return vector_of(scene.packed.view.background);
    switch (hit.body->surface->tags.SURFACE_KIND) {
    case KIND_MATTE:
        return direct_light(scene, ray, hit);
    case KIND_MIRROR:
        return reflect(scene, ray, hit, ray.branch, 1);
    default:
        return split(scene, ray, hit);
    }
}

bool is_narrow(const Ball &seen)
{
    return seen.radius() <= 0x1p-80 * (std::fabs(seen.middle()) + 0x1p-20);
}

} // namespace

/* Of surfaces in the same place the first is hit, and the others never. */
Oracle::Oracle(const packed_scene &packed) : scene(packed)
{
    for (int i = 0; i < packed.sphere_count; ++i) {
        const PackedSphere &sphere = packed.spheres[i];
        const PackedSurface &surface = packed.surfaces[sphere.tags.SURFACE];
        bodies.push_back({true, vector_of(sphere.center_radius), sphere.center_radius.w,
                          is_giant(&packed, i) ? surface.more_parameters.CURVATURE : 0, &surface,
                          sphere.tags.FILE_ORDER, true});
    }
    for (int i = 0; i < packed.plane_count; ++i) {
        const PackedPlane &plane = packed.planes[i];
        bodies.push_back({false, vector_of(plane.normal_offset), plane.normal_offset.w, 0, &plane.surface,
                          plane.surface.tags.FILE_ORDER, plane.surface.tags.CASTS_SHADOWS != 0});
    }
    std::sort(bodies.begin(), bodies.end(),
              [](const OracleBody &a, const OracleBody &b) { return a.order < b.order; });
    std::set<std::tuple<bool, double, double, double, double, double>> places;
    auto hidden = [&places](const OracleBody &body) {
        const double x = body.vector.x.middle(), y = body.vector.y.middle(), z = body.vector.z.middle();
        return !places.insert({body.is_sphere, x, y, z, body.number.middle(), body.curvature}).second;
    };
    bodies.erase(std::remove_if(bodies.begin(), bodies.end(), hidden), bodies.end());
}

OraclePixel Oracle::trace(int x, int y) const
{
    const PackedView &view = scene.view;
    const Vector direction = vector_of(view.forward) +
                             Ball(2 * x + 1 - scene.width) * vector_of(view.half_pixel_right) +
                             Ball(2 * y + 1 - scene.height) * vector_of(view.half_pixel_down);
    const Ray primary = {vector_of(view.position), direction, nullptr, false, 0, 0, 1};
    const uint32_t seed = hash(hash((uint32_t)x) + (uint32_t)y);
    for (Precision::bits = Precision::first;; Precision::bits *= 2) {
        int ties = Precision::undecided = 0;
        try {
            const Vector seen = radiance({scene, bodies, seed, ties}, primary);
            if (Precision::bits >= Precision::last ||
                (is_narrow(seen.x) && is_narrow(seen.y) && is_narrow(seen.z)))
                return {seen, Precision::bits, ties, Precision::undecided};
        } catch (const Undecided &) {
        }
    }
}
