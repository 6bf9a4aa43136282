#include "tracer/shader_rules.h"

#include <stdio.h>
#include <stdlib.h>

/* Numbers of the SPIR-V specification and of GLSL.std.450. */
enum {
    HEADER_WORDS = 5,
    OP_STRING = 7,
    OP_LINE = 8,
    OP_EXT_INST = 12,
    OP_VARIABLE = 59,
    OP_DECORATE = 71,
    OP_QUANTIZE = 116,
    OP_NEGATE = 127,
    OP_ADD = 129,
    OP_SUBTRACT = 131,
    OP_MULTIPLY = 133,
    OP_DIVIDE = 136,
    OP_REMAINDER = 140,
    OP_MODULUS = 141,
    OP_VECTOR_TIMES_SCALAR = 142,
    OP_OUTER_PRODUCT = 147, /* from the above on all that multiply vectors and matrices */
    OP_DOT = 148,
    DECORATION_BINDING = 33,
    DECORATION_DESCRIPTOR_SET = 34,
    DECORATION_NO_CONTRACTION = 42,
    CLASS_UNIFORM_CONSTANT = 0,
    CLASS_UNIFORM = 2,
    CLASS_STORAGE_BUFFER = 12,
};

/* What is known of an id. */
struct fact {
    uint32_t set, binding; /* of a variable's descriptor */
    bool exact;            /* an operation with NoContraction */
    const char *text;      /* of a string */
};

static bool judge_variable(uint32_t storage_class, const struct fact *place, struct shader_choice choice,
                           struct shader_problem *problem)
{
    if (storage_class != CLASS_UNIFORM_CONSTANT && storage_class != CLASS_UNIFORM &&
        storage_class != CLASS_STORAGE_BUFFER)
        return true;
    const uint32_t bindings = choice.variant < WHITTED_EXACT_EVENTS ? EVENTS : BINDINGS;
    if (place->set != 0 || place->binding >= bindings) {
        snprintf(problem->text, sizeof problem->text,
                 "set %u, binding %u: the program provides bindings 0 to %u of set 0", place->set,
                 place->binding, bindings - 1);
        return false;
    }
    const VkDescriptorType type = binding_type(place->binding, choice.scene_in_storage);
    const bool provided =
        choice.scene_in_storage || place->binding < RECORDS || place->binding >= SCENE_BINDINGS;
    if (provided && storage_class == (type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER   ? CLASS_STORAGE_BUFFER
                                      : type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? CLASS_UNIFORM
                                                                                  : CLASS_UNIFORM_CONSTANT))
        return true;
    snprintf(problem->text, sizeof problem->text, "set 0, binding %u: the program provides a %s there",
             place->binding,
             !provided                                   ? "buffer only with a large scene"
             : type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ? "storage buffer"
             : type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? "uniform buffer"
                                                         : "storage texel buffer");
    return false;
}

/* Those of GLSL.std.450 that round nothing: of magnitudes and signs, of integers; and the square root. */
static bool is_exact_function(uint32_t function)
{
    enum { F_ABS = 4, S_SIGN = 7, SQRT = 31, FIND_LSB = 73, FIND_U_MSB = 75 };
    enum { U_MIN = 38, S_MIN = 39, U_MAX = 41, S_MAX = 42, U_CLAMP = 44, S_CLAMP = 45 };
    return (function >= F_ABS && function <= S_SIGN) || (function >= FIND_LSB && function <= FIND_U_MSB) ||
           function == SQRT || function == U_MIN || function == S_MIN || function == U_MAX ||
           function == S_MAX || function == U_CLAMP || function == S_CLAMP;
}

/* Whether the operation may stand in exact mode. */
static bool judge_operation(const uint32_t *words, const struct fact *facts, struct shader_problem *problem)
{
    const uint32_t operation = words[0] & 0xffff;
    const char *fault = NULL;
    if (operation == OP_NEGATE || operation == OP_ADD || operation == OP_SUBTRACT ||
        operation == OP_MULTIPLY || operation == OP_DIVIDE ||
        (operation >= OP_VECTOR_TIMES_SCALAR && operation <= OP_OUTER_PRODUCT))
        fault = facts[words[2]].exact
                    ? NULL
                    : "an operation without NoContraction: declare its result 'exact', or render with --fast";
    else if (operation == OP_DOT || operation == OP_QUANTIZE || operation == OP_REMAINDER ||
             operation == OP_MODULUS || (operation == OP_EXT_INST && !is_exact_function(words[4])))
        fault = "a built-in function that need not be correctly rounded: write it out, or render with --fast";
    if (fault)
        snprintf(problem->text, sizeof problem->text, "%s", fault);
    return !fault;
}

bool shader_obeys(struct spirv code, struct shader_choice choice, struct shader_problem *problem)
{
    const size_t count = code.size / sizeof *code.words;
    const uint32_t bound = code.words[3]; /* of all ids */
    struct fact *facts = calloc(bound, sizeof *facts);
    bool obeys = facts != NULL;
    *problem = (struct shader_problem){0};
    if (!facts)
        snprintf(problem->text, sizeof problem->text, "no memory to look at its %u ids", bound);
    for (size_t at = HEADER_WORDS; at < count && obeys; at += code.words[at] >> 16) {
        const uint32_t *words = code.words + at, operation = words[0] & 0xffff;
        if (operation == OP_STRING) {
            facts[words[1]].text = (const char *)&words[2];
        } else if (operation == OP_DECORATE) {
            struct fact *fact = &facts[words[1]];
            fact->exact = fact->exact || words[2] == DECORATION_NO_CONTRACTION;
            if (words[2] == DECORATION_BINDING)
                fact->binding = words[3];
            else if (words[2] == DECORATION_DESCRIPTOR_SET)
                fact->set = words[3];
        } else if (operation == OP_LINE) {
            problem->file = facts[words[1]].text;
            problem->line = words[2];
        } else if (operation == OP_VARIABLE) {
            obeys = judge_variable(words[3], &facts[words[2]], choice, problem);
        } else if (choice.variant != WHITTED_FAST) {
            obeys = judge_operation(words, facts, problem);
        }
    }
    free(facts);
    return obeys;
}
