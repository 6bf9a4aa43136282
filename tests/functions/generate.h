#ifndef GENERATE_H
#define GENERATE_H

#include "function_table.h"

/* Cases for the functions, half of them or more at an edge: inputs of one call, in the order in which
 * functions.comp reads them. */
typedef void generate_case(struct random *random, const struct promises *promises,
                           struct word_writer *inputs);

generate_case generate_quotient, generate_root, generate_vector, generate_hash, generate_sobol;
generate_case generate_sphere_ray, generate_plane_ray, generate_scene_ray;
generate_case generate_sphere_segment, generate_plane_segment;
generate_case generate_reflection, generate_refraction, generate_oren_nayar;
generate_case generate_point_light, generate_quad_light;

/* Parts of those. */
struct PackedSphere random_sphere(struct random *random);
struct PackedPlane random_plane(struct random *random, const struct promises *promises);

/* From start so far in a random direction along the plane. */
struct dvec3 random_in_plane(struct random *random, const struct PackedPlane *plane, struct dvec3 start,
                             double distance);

void put_sphere(struct word_writer *inputs, const struct PackedSphere *sphere);
void put_plane(struct word_writer *inputs, const struct PackedPlane *plane);

#endif
