/* What is declared of a shader's arithmetic is what the device offers, and valid. */
#include "cmocka_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test_folder.h"
#include "tracer/interface.h"
#include "vulkan/float_controls.h"

static struct vulkan_context device(VkBool32 in_float, VkBool32 in_double)
{
    return (struct vulkan_context){.float_controls = {.shaderSignedZeroInfNanPreserveFloat32 = in_float,
                                                      .shaderSignedZeroInfNanPreserveFloat64 = in_double,
                                                      .shaderRoundingModeRTEFloat32 = in_float,
                                                      .shaderRoundingModeRTEFloat64 = in_double}};
}

/* The words that are declared of the built shader. */
static size_t words_more(enum whitted_variant variant, VkBool32 in_float, VkBool32 in_double)
{
    const struct vulkan_context context = device(in_float, in_double);
    const struct spirv built = whitted_spirv((struct shader_choice){variant, false}, false);
    const struct spirv declared = float_controls_declare(&context, built);
    FILE *file = fopen("declared.spv", "wb");
    assert_non_null(declared.words);
    assert_non_null(file);
    assert_int_equal(fwrite(declared.words, 1, declared.size, file), declared.size);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(system("spirv-val --target-env vulkan1.2 declared.spv"), 0);
    const size_t more = (declared.size - built.size) / sizeof *built.words;
    free((void *)(uintptr_t)declared.words);
    return more;
}

/* A capability takes two words, and a mode four for each width. */
static void what_is_offered(void **state)
{
    (void)state;
    assert_int_equal(words_more(WHITTED_EXACT, VK_FALSE, VK_FALSE), 0);
    assert_int_equal(words_more(WHITTED_EXACT, VK_TRUE, VK_FALSE), 2 * (2 + 4));
    assert_int_equal(words_more(WHITTED_DOUBLE, VK_TRUE, VK_FALSE), 0);
    assert_int_equal(words_more(WHITTED_DOUBLE, VK_TRUE, VK_TRUE), 2 * (2 + 4 + 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_is_offered, test_folder_setup, test_folder_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
