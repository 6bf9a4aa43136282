#ifndef VKWHITTED_WHITTED_SPIRV_H
#define VKWHITTED_WHITTED_SPIRV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct spirv {
    const uint32_t *words;
    size_t size; /* bytes */
};

/* shaders/whitted.comp as compiled by the build: exact or fast, the scene in uniform or in storage buffers.
 */
struct spirv whitted_spirv(bool fast, bool scene_in_storage);

#endif
