/* Shaders compiled in the program: the same SPIR-V as the build's, messages that lead to the file and line
 * that is wrong, rules for what may stand in one, and a glslang that may crash. */
#include "cmocka_test.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "test_folder.h"
#include "tracer/shader_folder.h"
#include "tracer/shader_rules.h"

static struct compilation compile(const char *path, const char *const *options, enum status expected)
{
    struct compilation compilation;
    enum status status = shader_compile(path, options, &compilation);
    if (status != expected)
        print_error("%s: %s\n", path, compilation.messages);
    assert_int_equal(status, expected);
    assert_true((compilation.words != NULL) == (expected == STATUS_DONE));
    return compilation;
}

static const char *const no_options[] = {NULL};

static void same_as_the_build(void **state)
{
    (void)state;
    static const struct shader_choice choices[] = {
        {WHITTED_EXACT, false}, {WHITTED_FAST, true}, {WHITTED_CORRECTED_EVENTS, true}};
    for (int i = 0; i < 3; ++i) {
        struct spirv built = whitted_spirv(choices[i], false);
        const bool optimised =
            choices[i].variant < WHITTED_EXACT_EVENTS; /* shader_build() never takes the time */
        const char *options[1 + MOST_DEFINES] = {optimised ? "-Os" : "-DUNOPTIMISED"};
        shader_defines(choices[i], options + 1);
        struct compilation compilation = compile(SOURCE_DIR "/shaders/whitted.comp", options, STATUS_DONE);
        assert_string_equal(compilation.messages, "");
#if !SHADER_DEBUG_INFO /* which holds paths */
        assert_int_equal(compilation.size, built.size);
        assert_memory_equal(compilation.words, built.words, built.size);
#endif
        compilation_destroy(&compilation);
    }
}

static void the_builds_obey(void **state)
{
    (void)state;
    for (int i = 0; i < WHITTED_VARIANTS * 4; ++i) {
        const struct shader_choice choice = {(enum whitted_variant)(i / 4), i & 1};
        struct shader_problem problem;
        if (!shader_obeys(whitted_spirv(choice, i & 2), choice, &problem))
            fail_msg("variant %d, storage %d, plain %d: %s", i / 4, i & 1, i & 2, problem.text);
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
    "layout(std430, set = 0, binding = 8) buffer Out { float x[]; };\n"
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
        {MAIN, "float y = z;", "./main.comp:15: error: 'z' : undeclared identifier\n"},
        {OUTER, "float y = z;", "./outer.glsl:5: error: 'z' : undeclared identifier\n"},
        {INNER, "float y = z;", "./sub/inner.glsl:4: error: 'z' : undeclared identifier\n"},
        {INNER, "\n\n\nfloat y = z;", "./sub/inner.glsl:7: error: 'z' : undeclared identifier\n"},
        {OUTER, "float y 1;", "./outer.glsl:5: error: syntax error, unexpected INTCONSTANT"},
        {INNER, "#error not yet", "./sub/inner.glsl:4: error: '#error' : not yet\n"},
        {MAIN, "#include \"nothing.glsl\"", "./main.comp:15: error: cannot include nothing.glsl\n"},
        {INNER, "#include \"nothing.glsl\"", "./sub/inner.glsl:4: error: cannot include nothing.glsl\n"},
        {MORE, "float y = z;", "./more.glsl:1: error: 'z' : undeclared identifier\n"},
        {OUTER, "#endif", "./outer.glsl:5: error: '#endif' : mismatched statements\n"},
    };
    static const char *const defined[] = {"-DDEFINED", NULL};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        write_shader(cases[i].file, cases[i].mark);
        struct compilation compilation = compile("./main.comp", defined, STATUS_REFUSED);
        const char *end = strchr(compilation.messages, '\n');
        if (strncmp(compilation.messages, cases[i].message, strlen(cases[i].message)) != 0 || !end || end[1])
            fail_msg("expected: %sfound: %s", cases[i].message, compilation.messages);
        compilation_destroy(&compilation);
    }
    write_shader(MAIN, "#ifndef DEFINED\n#error without defines\n#endif");
    struct compilation good = compile("./main.comp", defined, STATUS_DONE);
    assert_string_equal(good.messages, "");
    compilation_destroy(&good);
    remove_shader();
}

static void assert_followed(const struct compilation *compilation, const char *const *paths_expected)
{
    for (const char *const *expected = paths_expected; *expected; ++expected) {
        bool found = false;
        for (const char *path = compilation->files; *path; path += strlen(path) + 1)
            found = found || strcmp(path, *expected) == 0;
        if (!found)
            fail_msg("%s is not among the files", *expected);
    }
}

/* After an error, the file that is wrong and the one that is missing, wherever they are. */
static void files_to_follow(void **state)
{
    (void)state;
    write_shader(MAIN, "");
    struct compilation compilation = compile("./main.comp", no_options, STATUS_DONE);
    assert_followed(&compilation, (const char *const[]){"./main.comp", "./outer.glsl", "./sub/inner.glsl",
                                                        "./more.glsl", NULL});
    compilation_destroy(&compilation);
    write_shader(INNER, "#include \"../a\"");
    compilation = compile("./main.comp", no_options, STATUS_REFUSED);
    assert_followed(&compilation, (const char *const[]){"./sub/inner.glsl", "./sub/../a", NULL});
    compilation_destroy(&compilation);
    write_shader(INNER, "#include \"../a\"");
    write_file("a", "wrong");
    compilation = compile("./main.comp", no_options, STATUS_REFUSED);
    assert_followed(&compilation, (const char *const[]){"./sub/../a", NULL});
    compilation_destroy(&compilation);
    assert_int_equal(unlink("a"), 0);
    remove_shader();
    assert_int_equal(mkdir("a b", 0777), 0);
    write_file("a b/c d.comp", "#version 460\nvoid main() {}\n");
    compilation = compile("a b/c d.comp", no_options, STATUS_DONE);
    assert_followed(&compilation, (const char *const[]){"a b/c d.comp", NULL});
    compilation_destroy(&compilation);
    assert_int_equal(unlink("a b/c d.comp") | rmdir("a b"), 0);
}

static void no_shader_at_all(void **state)
{
    static const char *const texts_that_are_none[] = {"", "float x;", "#version 460\n"};
    (void)state;
    struct compilation compilation = compile("./main.comp", no_options, STATUS_REFUSED);
    assert_memory_equal(compilation.messages, "./main.comp: error: ", 20);
    compilation_destroy(&compilation);
    for (size_t i = 0; i < 3; ++i) {
        write_file("main.comp", texts_that_are_none[i]);
        compilation = compile("./main.comp", no_options, STATUS_REFUSED);
        assert_memory_equal(compilation.messages, "./main.comp", 11);
        assert_non_null(strstr(compilation.messages, "error: "));
        compilation_destroy(&compilation);
    }
}

/* An expression so deep that glslang overflows its stack. */
static void glslang_crashes(void **state)
{
    (void)state;
    FILE *file = fopen("main.comp", "w");
    assert_non_null(file);
    fputs("#version 460\nlayout(local_size_x = 1) in;\n"
          "layout(std430, set = 0, binding = 8) buffer Out { float x[]; };\n"
          "void main() { float a = x[0]; x[1] = a",
          file);
    for (int i = 0; i < 200000; ++i)
        fputs("+a", file);
    fputs("; }\n", file);
    fclose(file);
    struct compilation compilation = compile("./main.comp", no_options, STATUS_REFUSED);
    assert_memory_equal(compilation.messages, "./main.comp: error: glslangValidator ended early: ", 50);
    compilation_destroy(&compilation);
    compilation = compile(SOURCE_DIR "/shaders/whitted.comp", no_options, STATUS_DONE);
    compilation_destroy(&compilation);
}

/* Macros that stand for 8^12 tokens. */
static void glslang_does_not_end(void **state)
{
    (void)state;
    FILE *file = fopen("main.comp", "w");
    assert_non_null(file);
    fputs("#version 460\nlayout(local_size_x = 1) in;\n#define A0 +1\n", file);
    for (int i = 1; i <= 12; ++i) {
        fprintf(file, "#define A%d", i);
        for (int j = 0; j < 8; ++j)
            fprintf(file, " A%d", i - 1);
        fputs("\n", file);
    }
    fputs("void main() { int y = 0 A12; }\n", file);
    fclose(file);
    struct compilation compilation = compile("./main.comp", no_options, STATUS_REFUSED);
    assert_memory_equal(compilation.messages, "./main.comp: error: glslangValidator ended early: ", 50);
    compilation_destroy(&compilation);
}

static void buffers_that_are_not_there(void **state)
{
    static const char *const interfaces[] = {
        "set = 0, binding = 12) buffer",         "set = 1, binding = 8) buffer",
        "set = 0, binding = 0) buffer",          "set = 0, binding = 1) buffer",
        "set = 0, binding = 8) readonly buffer",
    };
    (void)state;
    for (int i = 0; i < 5; ++i) {
        char text[512];
        struct shader_problem problem;
        snprintf(
            text, sizeof text,
            "#version 460\nlayout(local_size_x = 1) in;\nlayout(std430, %s Out { float x[]; };\n"
            "layout(std430, set = 0, binding = 9) buffer Kept { float y; };\nvoid main() { y = x[0]; }\n",
            interfaces[i]);
        write_file("main.comp", text);
        struct compilation compilation = compile("./main.comp", no_options, STATUS_DONE);
        const struct spirv code = {compilation.words, compilation.size};
        assert_int_equal(shader_obeys(code, (struct shader_choice){WHITTED_EXACT, false}, &problem), i == 4);
        assert_int_equal(shader_obeys(code, (struct shader_choice){WHITTED_EXACT, true}, &problem), i >= 3);
        assert_int_equal(shader_obeys(code, (struct shader_choice){WHITTED_EXACT_EVENTS, false}, &problem),
                         i == 4 || i == 0);
        compilation_destroy(&compilation);
    }
}

/* Operations are looked for in the second file. STATUS_DONE, or where they are refused STATUS_REFUSED. */
static enum status build_with(const char *operations, enum whitted_variant variant)
{
    char text[512];
    struct compilation compilation;
    snprintf(text, sizeof text, "void use(float a, float b, vec3 v, int i)\n{\n    %s;\n}\n", operations);
    write_file("more.glsl", text);
    const enum status status =
        shader_build("./main.comp", (struct shader_choice){variant, false}, &compilation);
    assert_true((compilation.words != NULL) == (status == STATUS_DONE));
    if (status != STATUS_DONE &&
        strncmp(compilation.messages, "./more.glsl:3: error: ", strlen("./more.glsl:3: error: ")) != 0)
        fail_msg("%s: %s", operations, compilation.messages);
    compilation_destroy(&compilation);
    return status;
}

static void operations_that_are_not_exact(void **state)
{
    static const char *const operations[] = {
        "a + b",
        "a - b",
        "a * b",
        "a / b",
        "-a",
        "v * a",
        "mat3(a) * v",
        "dot(v, v)",
        "mod(a, b)",
        "mix(a, b, a)",
        "normalize(v)",
        "min(a, b)",
        "outerProduct(v, v)",
    };
    (void)state;
    write_file("main.comp", "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
                            "layout(local_size_x = 1) in;\n"
                            "layout(std430, set = 0, binding = 8) buffer Out { float x[]; };\n"
                            "#include \"more.glsl\"\n"
                            "void main() { use(x[0], x[1], vec3(x[2]), int(x[3])); }\n");
    for (size_t i = 0; i < sizeof operations / sizeof *operations; ++i)
        if (build_with(operations[i], WHITTED_EXACT) != STATUS_REFUSED)
            fail_msg("%s is not refused", operations[i]);
    const char *all_exact =
        "precise float c = -a * b + a / b; sqrt(a); abs(a); sign(a); a < b ? a : b; i * 3;\n"
        "min(i, 3); findMSB(i); float(i); floatBitsToInt(a); isnan(a)";
    assert_int_equal(build_with(all_exact, WHITTED_EXACT), STATUS_DONE);
    assert_int_equal(build_with("normalize(v) * a", WHITTED_FAST), STATUS_DONE);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, test_folder_setup, test_folder_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(same_as_the_build),         TEST(the_builds_obey),      TEST(operations_that_are_not_exact),
        TEST(messages_lead_to_the_file), TEST(files_to_follow),      TEST(no_shader_at_all),
        TEST(glslang_crashes),           TEST(glslang_does_not_end), TEST(buffers_that_are_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
