/* Whole files are read, and what cannot be read says why. */
#include "cmocka_test.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>

#include "base/output_file.h"
#include "base/text_file.h"
#include "test_folder.h"

enum { SIZE = 100000 };

static char *some_bytes(void)
{
    char *bytes = malloc(SIZE);
    assert_non_null(bytes);
    for (int i = 0; i < SIZE; ++i)
        bytes[i] = (char)(i * 7);
    return bytes;
}

static void test_sizes(void **state)
{
    (void)state;
    static const size_t sizes[] = {0, 1, 4095, 4096, 4097, 8192, SIZE};
    char *bytes = some_bytes();
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        size_t length = 77;
        test_write_file("a", bytes, sizes[i]);
        char *text = text_file_read("a", i % 2 == 0, sizes[i], &length);
        assert_non_null(text);
        assert_int_equal(length, sizes[i]);
        assert_memory_equal(text, bytes, length);
        assert_int_equal(text[length], 0);
        free(text);
        if (sizes[i] == 0)
            continue;
        errno = 0;
        assert_null(text_file_read("a", i % 2 == 0, sizes[i] - 1, &length));
        assert_int_equal(errno, EFBIG);
    }
    free(bytes);
}

static void assert_unread(const char *path, bool regular_only, int error)
{
    size_t length;
    errno = 0;
    assert_null(text_file_read(path, regular_only, SIZE, &length));
    assert_int_equal(errno, error);
}

static void test_refusals(void **state)
{
    (void)state;
    assert_int_equal(mkdir("folder", 0777), 0);
    assert_int_equal(mkfifo("fifo", 0666), 0);
    for (int regular_only = 0; regular_only < 2; ++regular_only) {
        assert_unread("missing", regular_only, ENOENT);
        assert_unread("folder", regular_only, EISDIR);
    }
    assert_unread("fifo", true, EINVAL);
    assert_unread("/dev/null", true, EINVAL);
    assert_unread("/dev/zero", false, EFBIG);
}

static void pause_ms(long milliseconds)
{
    nanosleep(&(struct timespec){.tv_nsec = milliseconds * 1000000}, NULL);
}

/* A process that writes the bytes to the pipe in two parts and then, after a while, closes it. */
static pid_t start_writer(const char *bytes)
{
    pid_t writer = fork();
    assert_true(writer >= 0);
    if (writer > 0)
        return writer;
    int fifo = open("fifo", O_WRONLY);
    bool written = write(fifo, bytes, 1000) == 1000;
    pause_ms(50);
    written = written && write(fifo, bytes + 1000, SIZE - 1000) == SIZE - 1000;
    pause_ms(50);
    _exit(!written);
}

static void test_pipe(void **state)
{
    (void)state;
    char *bytes = some_bytes();
    assert_int_equal(mkfifo("fifo", 0666), 0);
    size_t length = 0;
    int outcome;
    pid_t writer = start_writer(bytes);
    char *text = text_file_read("fifo", false, SIZE, &length);
    assert_int_equal(waitpid(writer, &outcome, 0), writer);
    assert_int_equal(outcome, 0);
    assert_non_null(text);
    assert_int_equal(length, SIZE);
    assert_memory_equal(text, bytes, SIZE);
    free(text);
    free(bytes);
}

/* Also by another name. */
static void test_outputs_are_not_read(void **state)
{
    (void)state;
    test_write_file("a", "x", 1);
    assert_int_equal(symlink("a", "b"), 0);
    assert_int_equal(link("a", "c"), 0);
    assert_int_equal(output_file_claim("b"), STATUS_DONE);
    assert_unread("a", false, EBUSY);
    assert_unread("c", true, EBUSY);
    output_file_release();
    size_t length;
    char *text = text_file_read("a", true, SIZE, &length);
    assert_non_null(text);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_sizes),
        TEST_IN_FOLDER(test_refusals),
        TEST_IN_FOLDER(test_pipe),
        TEST_IN_FOLDER(test_outputs_are_not_read),
    };
    return cmocka_run_group_tests_name("text_file", tests, NULL, NULL);
}
