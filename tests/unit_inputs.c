/* Whatever happens to the files of a picture is taken up when it is whole, and what happens beside them is
 * not. */
#include "cmocka_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/clock.h"
#include "test_folder.h"
#include "watch/inputs.h"

static const double patience_ms = 20000;
static struct inputs inputs;

static void write_file(const char *path)
{
    test_write_file(path, "text", 4);
}

/* Whether the files are taken within this time. */
static bool taken_within(double milliseconds)
{
    double saved_ms = 0, start_ms = clock_ms();
    while (!inputs_take(&inputs, &saved_ms)) {
        if (clock_ms() > start_ms + milliseconds)
            return false;
        nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    }
    assert_true(saved_ms <= clock_ms());
    assert_true(inputs_hold(&inputs));
    return true;
}

static void assert_taken(void)
{
    assert_true(taken_within(patience_ms));
    assert_false(taken_within(50));
}

/* A compilation from this file beside whitted.comp, and nothing else. */
static bool follow(const char *path, bool broken)
{
    char *files = calloc(1, strlen(path) + 2);
    assert_non_null(files);
    strcpy(files, path);
    bool held = inputs_hold(&inputs);
    inputs.shader_broken = broken;
    held = held && inputs_follow(&inputs, INPUT_SHADER, &files);
    free(files);
    return held;
}

static void ways_of_saving(void **state)
{
    static const char *const paths[] = {"scene", "sha{d}[e]rs/whitted.comp", "sha{d}[e]rs/sub/part.glsl",
                                        "outside"};
    (void)state;
    for (size_t i = 0; i < 4; ++i) {
        const char *path = paths[i];
        write_file(path);
        assert_taken();
        double before_ms = clock_ms(), saved_ms = 0;
        write_file(path);
        while (!inputs_take(&inputs, &saved_ms) && clock_ms() < before_ms + patience_ms)
            ;
        assert_true(saved_ms > before_ms - 11); /* the file system's clock ticks every 10 ms or less */
        write_file("new");
        assert_false(taken_within(50));
        assert_int_equal(rename("new", path), 0);
        assert_taken();
        assert_int_equal(unlink(path), 0);
        assert_taken();
        write_file(path);
        assert_taken();
        assert_int_equal(truncate(path, 1), 0);
        assert_taken();
    }
    write_file("sha{d}[e]rs/unrelated.png");
    write_file("sha{d}[e]rs/.part.glsl");
    write_file("sha{d}[e]rs/part.glsl~");
    assert_false(taken_within(300));
    write_file("sha{d}[e]rs/may_be_missing.glsl");
    assert_taken();
    assert_true(follow("outside", false));
    write_file("sha{d}[e]rs/may_be_missing.glsl");
    assert_false(taken_within(300));
    assert_int_equal(unlink("sha{d}[e]rs/unrelated.png") | unlink("sha{d}[e]rs/.part.glsl") |
                         unlink("sha{d}[e]rs/part.glsl~") | unlink("sha{d}[e]rs/may_be_missing.glsl"),
                     0);
}

static void links(void **state)
{
    (void)state;
    assert_int_equal(mkdir("one", 0777) | mkdir("two", 0777), 0);
    write_file("one/scene");
    write_file("two/scene");
    assert_int_equal(unlink("scene") | symlink("one", "folder") | symlink("folder/scene", "scene"), 0);
    assert_taken();
    write_file("one/scene"); /* where the link leads to */
    assert_taken();
    write_file("two/scene");
    assert_false(taken_within(50));
    assert_int_equal(symlink("two", "other") | rename("other", "folder"), 0); /* a link on the way */
    assert_taken();
    assert_int_equal(unlink("one/scene") | unlink("two/scene") | rmdir("one") | rmdir("two"), 0);
}

/* A file that is open for writing counts as half written, for a second. */
static void half_written(void **state)
{
    (void)state;
    FILE *file = fopen("scene", "w");
    assert_non_null(file);
    for (int i = 0; i < 3; ++i) {
        fputs("half", file);
        fflush(file);
        assert_false(taken_within(300));
    }
    fclose(file);
    double closed_ms = clock_ms();
    assert_taken();
    assert_true(clock_ms() < closed_ms + 900);
    file = fopen("scene", "w"); /* and never closed */
    double opened_ms = clock_ms();
    assert_taken();
    assert_true(clock_ms() > opened_ms + 900);
    fclose(file);
}

/* What changes while it is read is taken again. */
static void changed_while_read(void **state)
{
    (void)state;
    write_file("scene");
    assert_true(taken_within(patience_ms));
    write_file("scene");
    assert_false(inputs_hold(&inputs));
    assert_taken();
    write_file("outside");
    assert_taken();
    write_file("sha{d}[e]rs/whitted.comp");
    assert_false(follow("outside", false));
    assert_taken();
    write_file("another"); /* not known before the compilation */
    assert_false(follow("another", false));
    assert_taken();
    assert_true(follow("another", false));
    assert_false(taken_within(50));
    write_file("outside");
    assert_false(taken_within(50));
    assert_int_equal(unlink("another"), 0);
    assert_taken();
    assert_true(follow("missing", false));
    write_file("missing");
    assert_taken();
    char *none = NULL;
    assert_true(inputs_hold(&inputs));
    assert_int_equal(unlink("scene"), 0); /* between the two questions */
    assert_false(inputs_follow(&inputs, INPUT_SHADER, &none));
    assert_taken();
}

static bool follow_spheres(const char *path)
{
    char *files = path ? calloc(1, strlen(path) + 2) : NULL;
    if (path)
        strcpy(files, path);
    bool same = inputs_follow(&inputs, INPUT_SPHERES, &files);
    assert_null(files);
    return same;
}

/* Files with spheres are waited for when they are new, and count like the scene then. */
static void files_with_spheres(void **state)
{
    (void)state;
    assert_true(follow_spheres(NULL));
    assert_false(taken_within(50));
    FILE *file = fopen("rows", "w");
    assert_non_null(file);
    fputs("half", file);
    fflush(file);
    assert_false(follow_spheres("rows"));
    assert_false(inputs_hold(&inputs));
    assert_false(taken_within(300));
    fclose(file);
    assert_taken();
    assert_true(follow_spheres("rows"));
    assert_false(taken_within(50));
    write_file("rows");
    assert_taken();
    assert_int_equal(unlink("rows"), 0);
    assert_taken();
    assert_true(follow_spheres(NULL));
    write_file("rows");
    assert_false(taken_within(50));
}

/* Two saves of the same size in one tick of the file system's clock look the same. */
static void quick_saves(void **state)
{
    (void)state;
    for (int i = 0; i < 200; ++i) {
        char text[4] = "", expected[4];
        double saved_ms;
        snprintf(expected, sizeof expected, "%03d", i);
        for (int save = 0; save < 2; ++save) {
            FILE *file = fopen("scene", "r+");
            assert_non_null(file);
            fputs(save ? expected : "xxx", file);
            assert_int_equal(fclose(file), 0);
        }
        double start_ms = clock_ms();
        while (strcmp(text, expected) != 0 && clock_ms() < start_ms + patience_ms) {
            size_t length;
            char *read = inputs_take(&inputs, &saved_ms) ? inputs_read_scene(&inputs, &length) : NULL;
            if (read)
                snprintf(text, sizeof text, "%s", read);
            free(read);
        }
        assert_string_equal(text, expected);
    }
}

static int setup(void **state)
{
    if (test_folder_setup(state) != 0 || mkdir("sha{d}[e]rs", 0777) != 0 ||
        mkdir("sha{d}[e]rs/sub", 0777) != 0)
        return -1;
    write_file("scene");
    write_file("sha{d}[e]rs/whitted.comp");
    write_file("sha{d}[e]rs/sub/part.glsl");
    write_file("outside");
    if (inputs_create("scene", "sha{d}[e]rs", &inputs) != STATUS_DONE)
        return -1;
    assert_taken();
    assert_true(follow("outside", true));
    return 0;
}

static int teardown(void **state)
{
    inputs_destroy(&inputs);
    unlink("sha{d}[e]rs/sub/part.glsl");
    rmdir("sha{d}[e]rs/sub");
    unlink("sha{d}[e]rs/whitted.comp");
    return test_folder_teardown(state);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(ways_of_saving),     TEST(links),       TEST(half_written),
                                       TEST(changed_while_read), TEST(quick_saves), TEST(files_with_spheres)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
