#ifndef FUNCTION_TABLE_H
#define FUNCTION_TABLE_H

#include <stddef.h>

#include "random.h"
#include "records.h"
#include "vulkan/pass.h"

/* A word of a record in the device's buffers. */
union word {
    float number;
    int32_t integer;
};

enum { MOST_WORDS = 80 }; /* of a record */

enum { COMMON_CONSTANTS = 5, MOST_CONSTANTS = 9 };

/* Of every test that does not set its own: a scene of one sphere and one plane. */
extern const struct pass_constant common_constants[COMMON_CONSTANTS];

/* A function of the shaders, specialised somehow, and what it must be equal to. */
struct function_test {
    const char *name;     /* function/variant, where there are several */
    const char *function; /* of records.h */
    size_t input_words, output_words;
    const char *inputs, *outputs; /* their words, see function_table.c */
    struct promises promises;
    struct pass_constant constants[MOST_CONSTANTS]; /* those with id 0 are not there */
    void (*generate)(struct random *random, void *input);
    void (*call)(const void *input, void *output); /* of the C reference */
};

extern const struct function_test function_tests[];
extern const size_t function_test_count;

/* generate_NAME() draws a case, half of them or more at an edge; call_NAME() does with the C reference what
 * functions.comp does with the shaders. */
#define DECLARE(name)                                                                                        \
    void generate_##name(struct random *random, name##_input *input);                                        \
    void call_##name(const name##_input *input, name##_output *output);
FUNCTIONS(DECLARE)

enum { QUAD_LIGHT_SAMPLES = 4 };

#endif
