/* Output files appear whole or not at all, whatever goes wrong. */
#include "cmocka_test.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/output_file.h"
#include "test_folder.h"

static void assert_file(const char *name, const char *text)
{
    char found[256] = "";
    FILE *stream = fopen(name, "rb");
    assert_non_null(stream);
    size_t length = fread(found, 1, sizeof found - 1, stream);
    fclose(stream);
    found[length] = '\0';
    assert_string_equal(found, text);
}

static mode_t mode_of(const char *name)
{
    struct stat info;
    assert_int_equal(lstat(name, &info), 0);
    return info.st_mode;
}

/* Opens a file that must be refused with one message, "vkwhitted: error: PATH: " and in it reason. */
static void assert_refused(const char *path, const char *reason)
{
    struct output_file file;
    char line[256], start[128];
    test_messages_begin();
    enum status status = output_file_open(path, &file);
    int lines = test_messages_end(line);
    snprintf(start, sizeof start, "vkwhitted: error: %s: ", path);
    assert_int_equal(status, STATUS_UNABLE);
    assert_int_equal(lines, 1);
    assert_int_equal(strncmp(line, start, strlen(start)), 0);
    if (!strstr(line, reason))
        fail_msg("\"%s\" does not say \"%s\"", line, reason);
    output_file_abandon(&file);
}

static void test_commit_replaces(void **state)
{
    (void)state;
    test_write_file("target", "old", 3);
    struct output_file file;
    assert_int_equal(output_file_open("target", &file), STATUS_DONE);
    fputs("new text", file.stream);
    fflush(file.stream);
    assert_file("target", "old");
    assert_int_equal(output_file_commit(&file), STATUS_DONE);
    assert_file("target", "new text");
    output_file_abandon(&file);
    assert_int_equal(test_folder_files(0), 1);
}

static void test_write_at(void **state)
{
    (void)state;
    struct output_file file;
    assert_int_equal(output_file_open("./target", &file), STATUS_DONE);
    assert_true(output_file_write_at(&file, "world", 5, 6));
    assert_true(output_file_write_at(&file, "hello ", 6, 0));
    assert_int_equal(output_file_commit(&file), STATUS_DONE);
    assert_file("target", "hello world");
}

static void test_abandon_and_check_leave_nothing(void **state)
{
    (void)state;
    test_write_file("target", "old", 3);
    struct output_file file;
    assert_int_equal(output_file_open("target", &file), STATUS_DONE);
    fputs("new", file.stream);
    output_file_abandon(&file);
    output_file_abandon(&file);
    assert_int_equal(output_file_claim("target"), STATUS_DONE);
    assert_int_equal(output_file_claim("another"), STATUS_DONE);
    assert_file("target", "old");
    assert_int_equal(test_folder_files(0), 1);
    output_file_release();
}

static void commit_text(const char *path, const char *text)
{
    struct output_file file;
    assert_int_equal(output_file_open(path, &file), STATUS_DONE);
    fputs(text, file.stream);
    assert_int_equal(output_file_commit(&file), STATUS_DONE);
}

static void assert_claimed(const char *path)
{
    char line[256];
    test_messages_begin();
    enum status status = output_file_claim(path);
    int lines = test_messages_end(line);
    if (status != STATUS_REFUSED || lines != 1 || !strstr(line, ": is written already, as "))
        fail_msg("%s: status %d, %d lines: %s", path, status, lines, line);
}

/* By any name, until it is in place. */
static void test_claims(void **state)
{
    (void)state;
    test_write_file("target", "old", 3);
    assert_int_equal(mkdir("folder", 0777), 0);
    assert_int_equal(symlink("../folder", "folder/itself"), 0);
    assert_int_equal(symlink("target", "link"), 0);
    assert_int_equal(link("target", "hard"), 0);
    assert_int_equal(output_file_claim("target"), STATUS_DONE);
    assert_int_equal(output_file_claim("folder/target"), STATUS_DONE);
    assert_int_equal(output_file_claim("folder/target2"), STATUS_DONE);
    assert_claimed("target");
    assert_claimed("./target");
    assert_claimed("link");
    assert_claimed("hard");
    assert_claimed("folder/../hard");
    assert_claimed("folder/target");
    assert_claimed("folder//target");
    assert_claimed("folder/itself/target");
    commit_text("target", "new");
    assert_int_equal(output_file_claim("target"), STATUS_DONE);
    output_file_release();
    assert_int_equal(output_file_claim("hard"), STATUS_DONE);
    output_file_release();
    assert_int_equal(unlink("folder/itself"), 0);
}

static void test_permissions(void **state)
{
    (void)state;
    mode_t before = umask(027);
    commit_text("fresh", "x");
    test_write_file("private", "old", 3);
    chmod("private", 0604);
    commit_text("private", "new");
    umask(before);
    assert_int_equal(mode_of("fresh") & 0777, 0640);
    assert_int_equal(mode_of("private") & 0777, 0604);
    assert_file("private", "new");
}

static void test_symbolic_link_is_followed(void **state)
{
    (void)state;
    test_write_file("target", "old", 3);
    assert_int_equal(symlink("target", "link"), 0);
    commit_text("link", "new");
    assert_true(S_ISLNK(mode_of("link")));
    assert_file("target", "new");
    assert_int_equal(symlink("nowhere", "dangling"), 0);
    assert_refused("dangling", "No such file");
}

static void test_longest_name(void **state)
{
    (void)state;
    char name[256];
    memset(name, 'n', 255);
    name[255] = '\0';
    commit_text(name, "x");
    assert_file(name, "x");
}

static void test_refusals(void **state)
{
    (void)state;
    assert_int_equal(mkdir("folder", 0777), 0);
    assert_int_equal(mkfifo("fifo", 0666), 0);
    test_write_file("read-only", "old", 3);
    chmod("read-only", 0444);
    assert_refused("folder", "Is a directory");
    assert_refused("folder/", "Is a directory");
    assert_refused("", "No such file");
    assert_refused("missing/file", "No such file");
    assert_refused("missing/", "No such file");
    assert_refused("read-only/file", "Not a directory");
    assert_refused("fifo", "not a regular file");
    assert_refused("/dev/null", "not a regular file");
    if (geteuid() != 0) {
        assert_refused("read-only", "Permission denied");
        assert_int_equal(chmod("folder", 0555), 0);
        assert_refused("folder/file", "Permission denied");
    }
    assert_int_equal(rmdir("folder"), 0);
    assert_int_equal(test_folder_files(0), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_commit_replaces),
        TEST_IN_FOLDER(test_write_at),
        TEST_IN_FOLDER(test_abandon_and_check_leave_nothing),
        TEST_IN_FOLDER(test_claims),
        TEST_IN_FOLDER(test_permissions),
        TEST_IN_FOLDER(test_symbolic_link_is_followed),
        TEST_IN_FOLDER(test_longest_name),
        TEST_IN_FOLDER(test_refusals),
    };
    return cmocka_run_group_tests_name("output_file", tests, NULL, NULL);
}
