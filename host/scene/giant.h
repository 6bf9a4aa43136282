#ifndef VKWHITTED_SCENE_GIANT_H
#define VKWHITTED_SCENE_GIANT_H

#include <stdbool.h>

#include "scene/body.h"

enum { GIANT = 8 };

/* Whether the body is a giant: a ball with a radius of more than GIANT times the camera's coordinates and
 * its distance from the surface. Relative to its centre, places near the camera would lose more than 3 bits
 * of what float has of the coordinates; as a plane that curves, stored by what it is at the origin of
 * coordinates, it loses none. */
static inline bool giant_is(const struct scene *scene, struct body body)
{
    const struct dvec3 camera = dvec3_of(scene->camera.position);
    return body.is_ball && body.number > GIANT * dvec3_largest(camera) &&
           body.number > GIANT * fabs(body_distance(body, camera));
}

/* Of its surface over the origin, along the normal there. */
static inline double giant_height(struct body giant)
{
    return giant.number - dvec3_length(giant.vector);
}

#endif
