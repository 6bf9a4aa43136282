/* Shaders compiled in the program: the same SPIR-V as the build's, messages that lead to the file and line
 * that is wrong, and a glslang that may crash. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include <string.h>
#include <sys/stat.h>

#include "test_folder.h"
#include "tracer/tracer.h"
#include "watch/shader_compiler.h"

static struct shader_compiler *compiler;

static struct compilation compile(const char *path, const char *defines, enum status expected)
{
    struct shader_source source;
    struct compilation compilation;
    assert_int_equal(shader_source_read(path, &source), STATUS_DONE);
    enum status status = shader_compile(compiler, &source, defines, &compilation);
    if (status != expected)
        print_error("%s: %s\n", path, compilation.messages);
    assert_int_equal(status, expected);
    assert_true((compilation.words != NULL) == (expected == STATUS_DONE));
    shader_source_destroy(&source);
    return compilation;
}

static void same_as_the_build(void **state)
{
    (void)state;
    for (int variant = WHITTED_EXACT; variant <= WHITTED_FAST; ++variant)
        for (int storage = 0; storage < 2; ++storage) {
            const struct shader_choice choice = {(enum whitted_variant)variant, storage};
            struct spirv built = whitted_spirv(choice.variant, storage);
            struct compilation compilation = compile(SOURCE_DIR "/shaders/whitted.comp",
                                                     whitted_defines(choice.variant, storage), STATUS_DONE);
            char problem[128];
            assert_true(tracer_provides(built, choice, problem));
            assert_string_equal(compilation.messages, "");
#if !SHADER_DEBUG_INFO /* which holds paths */
            assert_int_equal(compilation.size, built.size);
            assert_memory_equal(compilation.words, built.words, built.size);
#endif
            compilation_destroy(&compilation);
        }
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* A shader of four files; MARK is replaced in one of them. */
enum { MAIN, OUTER, INNER, MORE, FILES };
static const char *const paths[FILES] = {"main.comp", "outer.glsl", "sub/inner.glsl", "more.glsl"};
static const char *const texts[FILES] = {
    "// a comment\n"
    "#version 460\n"
    "#extension GL_GOOGLE_include_directive : require\n"
    "/* #include \"nothing.glsl\"\n"
    "   #include \"nothing.glsl\" */\n"
    "// #include \"nothing.glsl\"\n"
    "// #include \"nothing.glsl\"\n"
    "#ifdef NOWHERE\n"
    "#include \"nothing.glsl\"\n"
    "#endif\n"
    "  #  include  \"outer.glsl\" /* and a comment\n"
    "that goes on */\n"
    "layout(local_size_x = 1) in;\n"
    "layout(std430, set = 0, binding = 5) buffer Out { float x[]; };\n"
    "MARK\n"
    "void main()\n"
    "{\n"
    "    x[0] = inner() + outer();\n"
    "}\n",
    "#include \"sub/inner.glsl\"\n"
    "#define LONG 1.0 + \\\n"
    "    2.0\n"
    "#include \"sub/inner.glsl\"\r\n"
    "MARK\n"
    "float outer()\n"
    "{\n"
    "    return LONG;\n"
    "}",
    "#ifndef INNER\n"
    "#define INNER\n"
    "#include \"more.glsl\" // beside an including file\n"
    "MARK\n"
    "float inner() { return TWO; }\n"
    "#endif\n",
    "const float TWO = 2.0; MARK",
};

static void remove_shader(void)
{
    for (int i = 0; i < FILES; ++i)
        assert_int_equal(unlink(paths[i]), 0);
    assert_int_equal(rmdir("sub"), 0);
}

static void write_shader(int marked, const char *mark)
{
    mkdir("sub", 0777);
    for (int i = 0; i < FILES; ++i) {
        char text[4096];
        const char *place = strstr(texts[i], "MARK");
        snprintf(text, sizeof text, "%.*s%s%s", (int)(place - texts[i]), texts[i], i == marked ? mark : "",
                 place + strlen("MARK"));
        write_file(paths[i], text);
    }
}

static void messages_lead_to_the_file(void **state)
{
    static const struct {
        int file;
        const char *mark, *message;
    } cases[] = {
        {MAIN, "float y = z;", "main.comp:15: error: 'z' : undeclared identifier\n"},
        {OUTER, "float y = z;", "outer.glsl:5: error: 'z' : undeclared identifier\n"},
        {INNER, "float y = z;", "sub/inner.glsl:4: error: 'z' : undeclared identifier\n"},
        {INNER, "\n\n\nfloat y = z;", "sub/inner.glsl:7: error: 'z' : undeclared identifier\n"},
        {OUTER, "float y 1;", "outer.glsl:5: error: syntax error, unexpected INTCONSTANT"},
        {INNER, "#error not yet", "sub/inner.glsl:4: error: #error not yet\n"},
        {MAIN, "#include \"nothing.glsl\"",
         "main.comp:15: error: cannot include nothing.glsl: No such file or directory\n"},
        {INNER, "#include \"nothing.glsl\"",
         "sub/inner.glsl:4: error: cannot include nothing.glsl: No such file or directory\n"},
        {OUTER, "#include \"main.comp\"", "outer.glsl:5: error: the file includes itself: main.comp\n"},
        {OUTER, "\n/* and so on", "outer.glsl:6: error: comment without end\n"},
        {MORE, "float y = z;", "more.glsl:1: error: 'z' : undeclared identifier\n"},
        {OUTER, "#if 0", "outer.glsl:5: error: #if without #endif\n"},
        {OUTER, "#endif", "outer.glsl:5: error: #endif without #if\n"},
        {MAIN, "#include \"sub\"", "main.comp:15: error: cannot include sub: Is a directory\n"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        write_shader(cases[i].file, cases[i].mark);
        struct compilation compilation = compile("main.comp", "#define DEFINED\n", STATUS_REFUSED);
        if (strncmp(compilation.messages, cases[i].message, strlen(cases[i].message)) != 0)
            fail_msg("expected: %sfound: %s", cases[i].message, compilation.messages);
        compilation_destroy(&compilation);
    }
    write_shader(MAIN, "#ifndef DEFINED\n#error without defines\n#endif");
    struct compilation good = compile("main.comp", "#define DEFINED\n", STATUS_DONE);
    assert_string_equal(good.messages, "");
    compilation_destroy(&good);
    remove_shader();
}

/* Also those that are missing: they may come. */
static void files_to_watch(void **state)
{
    static const char *const expected[] = {"main.comp",      "nothing.glsl",  "outer.glsl",
                                           "sub/inner.glsl", "sub/more.glsl", "more.glsl"};
    struct shader_source source;
    (void)state;
    write_shader(MAIN, "");
    assert_int_equal(shader_source_read("main.comp", &source), STATUS_DONE);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; ++i) {
        bool found = false;
        for (size_t j = 0; j < source.file_count; ++j)
            found = found || strcmp(source.files[j], expected[i]) == 0;
        if (!found)
            fail_msg("%s is not among the files", expected[i]);
    }
    shader_source_destroy(&source);
    remove_shader();
}

static void no_shader_at_all(void **state)
{
    (void)state;
    struct compilation compilation = compile("main.comp", "", STATUS_REFUSED);
    assert_string_equal(compilation.messages, "main.comp:1: error: No such file or directory\n");
    compilation_destroy(&compilation);
    write_file("main.comp", "");
    compilation = compile("main.comp", "", STATUS_REFUSED);
    assert_memory_equal(compilation.messages, "main.comp: error: ", 18);
    compilation_destroy(&compilation);
    FILE *file = fopen("main.comp", "w");
    assert_non_null(file);
    fwrite("#version 460\n\0void main() {}\n", 1, 28, file);
    fclose(file);
    compilation = compile("main.comp", "", STATUS_REFUSED);
    assert_string_equal(compilation.messages, "main.comp:1: error: not a text, it has a byte of value 0\n");
    compilation_destroy(&compilation);
}

/* An expression so deep that glslang overflows its stack. */
static void glslang_crashes(void **state)
{
    (void)state;
    FILE *file = fopen("main.comp", "w");
    assert_non_null(file);
    fputs("#version 460\nlayout(local_size_x = 1) in;\n"
          "layout(std430, set = 0, binding = 5) buffer Out { float x[]; };\n"
          "void main() { float a = x[0]; x[1] = a",
          file);
    for (int i = 0; i < 200000; ++i)
        fputs("+a", file);
    fputs("; }\n", file);
    fclose(file);
    struct compilation compilation = compile("main.comp", "", STATUS_REFUSED);
    assert_string_equal(compilation.messages, "main.comp: error: glslang crashed on this shader\n");
    compilation_destroy(&compilation);
    compilation = compile(SOURCE_DIR "/shaders/whitted.comp", "", STATUS_DONE);
    compilation_destroy(&compilation);
}

/* Macros that stand for 8^12 tokens. */
static void glslang_does_not_end(void **state)
{
    (void)state;
    FILE *file = fopen("main.comp", "w");
    assert_non_null(file);
    fputs("#version 460\nlayout(local_size_x = 1) in;\n#define A0 x\n", file);
    for (int i = 1; i <= 12; ++i) {
        fprintf(file, "#define A%d", i);
        for (int j = 0; j < 8; ++j)
            fprintf(file, " A%d", i - 1);
        fputs("\n", file);
    }
    fputs("void main() { A12 }\n", file);
    fclose(file);
    struct compilation compilation = compile("main.comp", "", STATUS_REFUSED);
    assert_memory_equal(compilation.messages, "main.comp: error: glslang ", 26);
    compilation_destroy(&compilation);
}

static void buffers_that_are_not_there(void **state)
{
    static const char *const interfaces[] = {
        "set = 0, binding = 8) buffer",          "set = 1, binding = 5) buffer",
        "set = 0, binding = 0) buffer",          "set = 0, binding = 1) buffer",
        "set = 0, binding = 5) readonly buffer",
    };
    (void)state;
    for (int i = 0; i < 5; ++i) {
        char text[512], problem[128];
        snprintf(text, sizeof text,
                 "#version 460\nlayout(local_size_x = 1) in;\nlayout(std430, %s Out { float x[]; };\n"
                 "shared float y;\nvoid main() { y = x[0]; }\n",
                 interfaces[i]);
        write_file("main.comp", text);
        struct compilation compilation = compile("main.comp", "", STATUS_DONE);
        const struct spirv code = {compilation.words, compilation.size};
        bool provided = tracer_provides(code, (struct shader_choice){WHITTED_EXACT, false}, problem);
        assert_int_equal(provided, i == 4);
        assert_int_equal(tracer_provides(code, (struct shader_choice){WHITTED_EXACT, true}, problem), i >= 3);
        compilation_destroy(&compilation);
    }
}

static int setup(void **state)
{
    (void)state;
    return shader_compiler_create(&compiler) == STATUS_DONE ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    shader_compiler_destroy(&compiler);
    return 0;
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, test_folder_setup, test_folder_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(same_as_the_build),          TEST(messages_lead_to_the_file), TEST(files_to_watch),
        TEST(no_shader_at_all),           TEST(glslang_crashes),           TEST(glslang_does_not_end),
        TEST(buffers_that_are_not_there),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
