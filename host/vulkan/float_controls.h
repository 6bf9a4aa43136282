#ifndef VKWHITTED_VULKAN_FLOAT_CONTROLS_H
#define VKWHITTED_VULKAN_FLOAT_CONTROLS_H

#include "vulkan/context.h"

/* A compiled shader. */
struct spirv {
    const uint32_t *words;
    size_t size; /* bytes */
};

/* Copies valid SPIR-V 1.4 or later and declares what the device offers of: rounding to nearest, ties to even;
 * zeros' signs, infinities and NaN kept (Vulkan 1.2, 39.5 "Floating-Point Controls"). The copy's words are to
 * be freed; NULL (reported) without memory. */
struct spirv float_controls_declare(const struct vulkan_context *context, struct spirv code);

#endif
