#ifndef VKWHITTED_SCENE_BODY_H
#define VKWHITTED_SCENE_BODY_H

#include <stdbool.h>

#include "packed_scene.h"
#include "scene/hierarchy.h"
#include "scene/scene.h"
#include "scene/vector.h"

/* What float arithmetic on coordinates of size 1 cannot resolve, a few units in the last place, is taken as
 * touching, not as crossing. */
#define RESOLUTION 0x1p-21

/* A ball (center, radius), or what lies behind a plane (unit normal, offset). */
struct body {
    bool is_ball;
    struct dvec3 vector;
    double number;
    bool is_giant; /* stored as such in the packed scene, in whose units it is; see giant_is() */
};

/* Where a body stands in the scene: an object, or a row of a file with spheres. */
struct body_place {
    const struct scene_object *object;
    size_t row;
};

/* The place of the body of that number, and the body. */
struct body_place body_find(const struct scene *scene, size_t number);
struct body body_numbered(const struct scene *scene, size_t number);

/* Calls visit for each body of the packed scene but the spheres of the hierarchy whose boxes do not touch the
 * box, by its number, until it returns false. */
void body_visit(const struct packed_scene *packed, struct box box, hierarchy_visitor *visit, void *user);

enum { BODY_NAME = 600 }; /* bytes; a name has fewer than 512 */

/* As messages have it, written to text: "Ball", or "Flake" row 17. */
const char *body_name(struct body_place place, char text[static BODY_NAME]);

/* The packed scene's spheres, then its planes. */
static inline int body_count(const struct packed_scene *scene)
{
    return scene->sphere_count + scene->plane_count;
}

static inline const PackedSurface *body_surface(const struct packed_scene *scene, int i)
{
    return i < scene->sphere_count ? &scene->surfaces[scene->spheres[i].tags.SURFACE]
                                   : &scene->planes[i - scene->sphere_count].surface;
}

/* Each of the surfaces that bodies have: those of spheres, then those of planes. */
static inline int packed_surface_count(const struct packed_scene *scene)
{
    return scene->surface_count + scene->plane_count;
}

static inline const PackedSurface *packed_surface(const struct packed_scene *scene, int i)
{
    return i < scene->surface_count ? &scene->surfaces[i] : &scene->planes[i - scene->surface_count].surface;
}

/* Its place in the scene file, where each row of a file of spheres counts. */
static inline int body_file_order(const struct packed_scene *scene, int i)
{
    return i < scene->sphere_count ? scene->spheres[i].tags.FILE_ORDER
                                   : scene->planes[i - scene->sphere_count].surface.tags.FILE_ORDER;
}

static inline layout_vec4 body_shape(const struct packed_scene *scene, int i)
{
    return i < scene->sphere_count ? scene->spheres[i].center_radius
                                   : scene->planes[i - scene->sphere_count].normal_offset;
}

static inline struct body body_packed(const struct packed_scene *scene, int i)
{
    layout_vec4 shape = body_shape(scene, i);
    struct body body = {i < scene->sphere_count, dvec3_of_vec4(shape), (double)shape.w, is_giant(scene, i)};
    if (body.is_giant) {
        const double curvature = (double)scene->surfaces[i].more_parameters.CURVATURE;
        body.number = sqrt(dvec3_dot(body.vector, body.vector) + 2 * curvature * body.number) / curvature;
        body.vector = dvec3_scale(-1 / curvature, body.vector);
    }
    return body;
}

/* Around a ball, rounded outwards. */
static inline struct box body_box(struct body ball)
{
    const double center[3] = {ball.vector.x, ball.vector.y, ball.vector.z};
    struct box box;
    for (int a = 0; a < 3; ++a) {
        box.lo[a] = nextafterf((float)(center[a] - ball.number), -INFINITY);
        box.hi[a] = nextafterf((float)(center[a] + ball.number), INFINITY);
    }
    return box;
}

/* Of a point from the body's surface; negative inside. */
static inline double body_distance(struct body body, struct dvec3 point)
{
    return body.is_ball ? dvec3_distance(point, body.vector) - body.number
                        : dvec3_dot(body.vector, point) - body.number;
}

/* Whether the body is a giant: a ball with a radius of more than eight times the camera's coordinates and
 * its distance from the surface. Relative to its centre, places near the camera would lose more than 3 bits
 * of what float has of the coordinates; as a plane that curves, stored by what it is at the origin of
 * coordinates, it loses none. */
static inline bool giant_is(const struct scene *scene, struct body body)
{
    const struct dvec3 camera = dvec3_of(scene->camera.position);
    return body.is_ball && body.number > 8 * dvec3_largest(camera) &&
           body.number > 8 * fabs(body_distance(body, camera));
}

/* Of its surface over the origin, along the normal there. */
static inline double giant_height(struct body giant)
{
    return giant.number - dvec3_length(giant.vector);
}

/* Whether the body's surface reaches into the ball; that of a larger ball around it does not. A giant's
 * surface is known by where things are that may touch it, which are in the scene's extent. */
static inline bool body_reaches_into(struct body body, struct body ball)
{
    double least = RESOLUTION * (ball.is_giant ? 2 : dvec3_length(ball.vector) + ball.number);
    return fabs(body_distance(body, ball.vector)) < ball.number - least;
}

#endif
