#ifndef VKWHITTED_TRACER_INTERFACE_H
#define VKWHITTED_TRACER_INTERFACE_H

#include <stdbool.h>

#include "vulkan/pass.h"

/* The bindings of the shader's set 0. */
enum {
    VIEW,
    SPHERES,
    PLANES,
    POINT_LIGHTS,
    QUAD_LIGHTS,
    RECORDS, /* this and the next two only where the scene is in storage buffers */
    RECORD_WORDS,
    SURFACES,
    SCENE_BINDINGS,
    PICTURE = SCENE_BINDINGS,
    SAVED_REALS,
    SAVED_WORDS,
    OUTCOME,
    EVENTS, /* of the variants that tell of one pixel */
    BINDINGS,
};

/* What the binding is: a uniform, storage or storage texel buffer. */
static inline VkDescriptorType binding_type(uint32_t binding, bool scene_in_storage)
{
    if (binding == RECORDS || binding == RECORD_WORDS)
        return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    return binding >= SURFACES || (binding != VIEW && scene_in_storage) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                        : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}

enum whitted_variant {
    WHITTED_EXACT,
    WHITTED_CORRECTED, /* for a device whose / or sqrt is not exact */
    WHITTED_DOUBLE,    /* exact, in double precision */
    WHITTED_FAST,
    /* these tell of one pixel, see shaders/events.glsl; in the order of those above */
    WHITTED_EXACT_EVENTS,
    WHITTED_CORRECTED_EVENTS,
    WHITTED_DOUBLE_EVENTS,
    WHITTED_VARIANTS
};

/* Which of the shader's variants is needed. */
struct shader_choice {
    enum whitted_variant variant;
    bool scene_in_storage;
};

struct tracer_options {
    bool double_precision;         /* exact mode only, on a device with fp64 */
    bool fast;                     /* contraction and built-in functions allowed */
    bool counts;                   /* pixels have ray counts and signatures instead of radiance */
    bool charges;                  /* pixels tell what they are charged for rays that are not traced */
    uint32_t event_room;           /* 0: no events are recorded; exact mode only */
    struct spirv code;             /* of the shader that tracer_shader() tells; empty: the build's */
    struct shader_folder *shaders; /* that the code is to come from, instead; NULL: none */
};

/* shaders/whitted.comp as compiled by the build, the scene in uniform or in storage buffers; only the latter
 * has a hierarchy. Where the rest of it is plain, see specialization.h, it may be a smaller variant. */
struct spirv whitted_spirv(struct shader_choice choice, bool plain);

#endif
