#ifndef VKWHITTED_TRACER_WHITTED_SPIRV_H
#define VKWHITTED_TRACER_WHITTED_SPIRV_H

#include <stdbool.h>

#include "vulkan/pass.h"

enum whitted_variant {
    WHITTED_EXACT,
    WHITTED_CORRECTED, /* for a device whose / or sqrt is not exact */
    WHITTED_DOUBLE,    /* exact, in double precision */
    WHITTED_FAST,
    /* these tell of one pixel, see shaders/events.glsl */
    WHITTED_EXACT_EVENTS,
    WHITTED_CORRECTED_EVENTS,
    WHITTED_DOUBLE_EVENTS,
};

/* shaders/whitted.comp as compiled by the build, the scene in uniform or in storage buffers. */
struct spirv whitted_spirv(enum whitted_variant variant, bool scene_in_storage);

/* The options with which the build has glslangValidator compile it; NULL behind the last. Not for the
 * variants that tell of one pixel. */
const char *const *whitted_defines(enum whitted_variant variant, bool scene_in_storage);

#endif
