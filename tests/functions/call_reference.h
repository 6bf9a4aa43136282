#ifndef CALL_REFERENCE_H
#define CALL_REFERENCE_H

#include "words.h"

enum { QUAD_LIGHT_SAMPLES = 4 };

/* Reads one case's inputs, calls the function of cpu_reference/ and writes what functions.comp should. */
typedef void call_reference(const union word *inputs, struct word_writer *outputs);

call_reference call_divide, call_square_root, call_unit, call_hash, call_sobol_point;
call_reference call_meet_sphere, call_meet_plane, call_sphere_hit_point, call_plane_hit_point,
    call_nearest_hit;
call_reference call_sphere_shadows, call_plane_shadows;
call_reference call_reflect, call_refract, call_fresnel;
call_reference call_oren_nayar, call_point_light, call_quad_light;

#endif
