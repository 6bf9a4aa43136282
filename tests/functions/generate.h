#ifndef GENERATE_H
#define GENERATE_H

#include "function_table.h"

/* Parts of the cases. */
struct PackedSphere random_sphere(struct random *random);
RayRecord ray_at_sphere(struct random *random, struct PackedSphere *sphere); /* which is surface 0 */
struct PackedPlane random_plane(struct random *random);

/* The point of the plane that is nearest to the origin. */
struct dvec3 nearest_to_origin(const struct PackedPlane *plane);

/* From start so far in a random direction along the plane. */
struct dvec3 random_in_plane(struct random *random, const struct PackedPlane *plane, struct dvec3 start,
                             double distance);

/* The way from a point of the surface to one of a light, as the renderer has it; a light as near as this does
 * not shine. */
SegmentRecord connect_points(struct dvec3 from_point, struct dvec3 to_point, int surface, bool inward);

#endif
