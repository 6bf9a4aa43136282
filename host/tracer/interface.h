#ifndef VKWHITTED_TRACER_INTERFACE_H
#define VKWHITTED_TRACER_INTERFACE_H

#include "tracer/whitted_spirv.h"

/* The bindings of the shader's set 0. */
enum {
    VIEW,
    SPHERES,
    PLANES,
    POINT_LIGHTS,
    QUAD_LIGHTS,
    SCENE_BINDINGS,
    PICTURE = SCENE_BINDINGS,
    SAVED_PIXELS,
    SAVED_STACKS,
    EVENTS, /* of the variants that tell of one pixel */
    BINDINGS,
};

/* Whether the binding is a storage buffer; otherwise it is a uniform buffer. */
bool is_storage_buffer(uint32_t binding, bool scene_in_storage);

/* Which of the shader's variants is needed. */
struct shader_choice {
    enum whitted_variant variant;
    bool scene_in_storage;
};

/* Whether the code, which is valid, uses no other buffers than a tracer provides: drivers crash otherwise. If
 * not, problem says what is wrong. */
bool tracer_provides(struct spirv code, struct shader_choice choice, char problem[128]);

#endif
