#include "tracer/interface.h"

#include <stdio.h>
#include <stdlib.h>

/* Numbers of the SPIR-V specification. */
enum {
    HEADER_WORDS = 5,
    OP_VARIABLE = 59,
    OP_DECORATE = 71,
    DECORATION_BINDING = 33,
    DECORATION_DESCRIPTOR_SET = 34,
    CLASS_UNIFORM_CONSTANT = 0,
    CLASS_UNIFORM = 2,
    CLASS_STORAGE_BUFFER = 12,
};

VkDescriptorType binding_type(uint32_t binding, bool scene_in_storage)
{
    if (binding == RECORDS || binding == RECORD_WORDS)
        return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    return binding >= SURFACES || (binding != VIEW && scene_in_storage) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                        : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}

/* Where a variable's descriptor is. */
struct place {
    uint32_t set, binding;
};

static bool judge_variable(uint32_t storage_class, struct place place, struct shader_choice choice,
                           char problem[128])
{
    if (storage_class != CLASS_UNIFORM_CONSTANT && storage_class != CLASS_UNIFORM &&
        storage_class != CLASS_STORAGE_BUFFER)
        return true;
    if (place.set != 0 || place.binding >= EVENTS) {
        snprintf(problem, 128, "set %u, binding %u: the program provides bindings 0 to %d of set 0",
                 place.set, place.binding, EVENTS - 1);
        return false;
    }
    const VkDescriptorType type = binding_type(place.binding, choice.scene_in_storage);
    const bool provided =
        choice.scene_in_storage || place.binding < RECORDS || place.binding >= SCENE_BINDINGS;
    if (provided && storage_class == (type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER   ? CLASS_STORAGE_BUFFER
                                      : type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? CLASS_UNIFORM
                                                                                  : CLASS_UNIFORM_CONSTANT))
        return true;
    snprintf(problem, 128, "set 0, binding %u: the program provides a %s there", place.binding,
             !provided                                   ? "buffer only with a large scene"
             : type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ? "storage buffer"
             : type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? "uniform buffer"
                                                         : "storage texel buffer");
    return false;
}

bool tracer_provides(struct spirv code, struct shader_choice choice, char problem[128])
{
    size_t count = code.size / sizeof *code.words;
    const uint32_t bound = code.words[3]; /* of all ids */
    struct place *places = calloc(bound, sizeof *places);
    bool provided = places != NULL;
    if (!places)
        snprintf(problem, 128, "no memory to look at its %u variables", bound);
    for (size_t at = HEADER_WORDS; at < count && provided; at += code.words[at] >> 16) {
        const uint32_t *words = code.words + at;
        uint32_t operation = words[0] & 0xffff;
        if (operation == OP_DECORATE && words[2] == DECORATION_BINDING)
            places[words[1]].binding = words[3];
        else if (operation == OP_DECORATE && words[2] == DECORATION_DESCRIPTOR_SET)
            places[words[1]].set = words[3];
        else if (operation == OP_VARIABLE)
            provided = judge_variable(words[3], places[words[2]], choice, problem);
    }
    free(places);
    return provided;
}
