#ifndef VKWHITTED_SCENE_BODY_H
#define VKWHITTED_SCENE_BODY_H

#include <stdbool.h>

#include "packed_scene.h"
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
};

static inline struct body body_of(const struct scene_object *object)
{
    if (object->type == OBJECT_SPHERE)
        return (struct body){true, dvec3_of(object->sphere.center), object->sphere.radius};
    struct dvec3 normal = dvec3_unit(dvec3_of(object->plane.normal));
    return (struct body){false, normal, dvec3_dot(normal, dvec3_of(object->plane.point))};
}

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

static inline layout_vec4 body_shape(const struct packed_scene *scene, int i)
{
    return i < scene->sphere_count ? scene->spheres[i].center_radius
                                   : scene->planes[i - scene->sphere_count].normal_offset;
}

static inline struct body body_packed(const struct packed_scene *scene, int i)
{
    layout_vec4 shape = body_shape(scene, i);
    return (struct body){i < scene->sphere_count, dvec3_of_vec4(shape), (double)shape.w};
}

/* Of a point from the body's surface; negative inside. */
static inline double body_distance(struct body body, struct dvec3 point)
{
    return body.is_ball ? dvec3_distance(point, body.vector) - body.number
                        : dvec3_dot(body.vector, point) - body.number;
}

/* Whether the body's surface reaches into the ball; that of a larger ball around it does not. */
static inline bool body_reaches_into(struct body body, struct body ball)
{
    double least = RESOLUTION * (dvec3_length(ball.vector) + ball.number);
    return fabs(body_distance(body, ball.vector)) < ball.number - least;
}

#endif
