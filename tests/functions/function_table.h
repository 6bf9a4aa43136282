#ifndef FUNCTION_TABLE_H
#define FUNCTION_TABLE_H

#include <stddef.h>

#include "random.h"
#include "vulkan/pass.h"
#include "words.h"

/* What a scene does not hold, so that a pipeline specialised to it can be tested on it. */
struct promises {
    bool never_entered; /* rays, shading points and lights are outside of spheres */
    bool opaque_planes; /* no plane is transparent */
    int axis;           /* planes' normals are along x 1, y 2, z 3, anything 0 */
    bool lambert;       /* no matte is rough */
    bool in_order;      /* spheres stand before planes in the scene file */
};

enum { COMMON_CONSTANTS = 4, MOST_CONSTANTS = 8 };

/* Of every test that does not set its own: a scene of one sphere and one plane. */
extern const struct pass_constant common_constants[COMMON_CONSTANTS];

/* A function of the shaders, specialised somehow, and what it must be equal to. */
struct function_test {
    const char *name;     /* function/variant, where there are several */
    const char *function; /* call_...() of functions.comp */
    struct promises promises;
    struct pass_constant constants[MOST_CONSTANTS]; /* those with id 0 are not there */
    void (*generate)(struct random *random, const struct promises *promises, struct word_writer *inputs);
    void (*call)(const union word *inputs, struct word_writer *outputs); /* of the C reference */
};

extern const struct function_test function_tests[];
extern const size_t function_test_count;

#endif
