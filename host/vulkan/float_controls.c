#include "vulkan/float_controls.h"

#include <stdlib.h>
#include <string.h>

/* Numbers of the SPIR-V specification. */
enum {
    HEADER_WORDS = 5,
    OP_ENTRY_POINT = 15,
    OP_EXECUTION_MODE = 16,
    OP_CAPABILITY = 17,
    CAPABILITY_FLOAT64 = 10,
};

/* A control: its capability and its execution mode, and whether the device offers it for 32 and for 64 bits.
 */
struct control {
    uint32_t capability, mode;
    VkBool32 offered, offered_64;
};

static uint32_t instruction(uint32_t words, uint32_t operation)
{
    return words << 16 | operation;
}

struct spirv float_controls_declare(const struct vulkan_context *context, struct spirv code)
{
    const VkPhysicalDeviceFloatControlsProperties *offered = &context->float_controls;
    const struct control controls[] = {
        {4466, 4461, offered->shaderSignedZeroInfNanPreserveFloat32,
         offered->shaderSignedZeroInfNanPreserveFloat64},
        {4467, 4462, offered->shaderRoundingModeRTEFloat32, offered->shaderRoundingModeRTEFloat64},
    };
    enum { CONTROLS = sizeof controls / sizeof *controls, MOST_WORDS_MORE = CONTROLS * (2 + 2 * 4) };
    const size_t count = code.size / sizeof *code.words;
    uint32_t *words = malloc(code.size + MOST_WORDS_MORE * sizeof *words), *end = words;
    bool has_double = false;
    if (!words) {
        log_error("no memory for a shader");
        return (struct spirv){0};
    }
    for (size_t at = HEADER_WORDS; at < count; at += code.words[at] >> 16)
        has_double = has_double || (code.words[at] == instruction(2, OP_CAPABILITY) &&
                                    code.words[at + 1] == CAPABILITY_FLOAT64);
    memcpy(end, code.words, HEADER_WORDS * sizeof *end);
    end += HEADER_WORDS;
    for (int i = 0; i < CONTROLS; ++i)
        if (controls[i].offered && (controls[i].offered_64 || !has_double)) {
            *end++ = instruction(2, OP_CAPABILITY);
            *end++ = controls[i].capability;
        }
    for (size_t at = HEADER_WORDS, length; at < count; at += length) {
        length = code.words[at] >> 16;
        memcpy(end, code.words + at, length * sizeof *end);
        end += length;
        if ((code.words[at] & 0xffff) != OP_ENTRY_POINT)
            continue;
        for (int i = 0; i < CONTROLS; ++i)
            for (uint32_t bits = 32; bits <= (has_double ? 64 : 32); bits += 32)
                if (controls[i].offered && (controls[i].offered_64 || !has_double)) {
                    memcpy(end,
                           (const uint32_t[]){instruction(4, OP_EXECUTION_MODE), code.words[at + 2],
                                              controls[i].mode, bits},
                           4 * sizeof *end);
                    end += 4;
                }
    }
    return (struct spirv){words, (size_t)(end - words) * sizeof *words};
}
