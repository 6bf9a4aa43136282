/* Whatever happens to a file that is watched is noticed, and what happens beside it is not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include <sys/stat.h>

#include "base/clock.h"
#include "test_folder.h"
#include "watch/file_watch.h"

static const double patience_ms = 20000;
static struct file_watch *watch;

static void write_file(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("text", file);
    assert_int_equal(fclose(file), 0);
}

/* Watches these two only, from now on. */
static bool watch_files(const char *first, const char *second)
{
    char *paths[] = {(char *)first, (char *)second};
    bool added = file_watch_set(watch, paths, 2);
    file_watch_settle(watch);
    return added;
}

static void assert_noticed(void)
{
    assert_true(file_watch_wait(watch, patience_ms));
    assert_true(file_watch_last_event_ms(watch) > clock_ms() - patience_ms);
    file_watch_settle(watch);
    assert_false(file_watch_wait(watch, 0));
}

static void ways_of_saving(void **state)
{
    (void)state;
    write_file("a");
    assert_true(watch_files("a", "missing"));
    assert_false(watch_files("missing", "a"));
    write_file("a");
    assert_noticed();
    write_file("b");
    assert_false(file_watch_wait(watch, 20));
    assert_int_equal(rename("b", "a"), 0);
    assert_noticed();
    assert_int_equal(unlink("a"), 0);
    assert_noticed();
    write_file("a");
    assert_noticed();
    assert_int_equal(truncate("a", 1), 0);
    assert_noticed();
    assert_int_equal(chmod("a", 0600), 0);
    assert_noticed();
    write_file("missing");
    assert_noticed();
    assert_true(watch_files("b", "b"));
    write_file("a");
    assert_false(file_watch_wait(watch, 20));
}

static void links_and_folders(void **state)
{
    (void)state;
    assert_int_equal(mkdir("one", 0777) | mkdir("two", 0777), 0);
    write_file("one/a");
    write_file("two/a");
    assert_int_equal(symlink("one", "folder") | symlink("folder/a", "link"), 0);
    assert_true(watch_files("link", "link"));
    write_file("one/a"); /* where the link leads to */
    assert_noticed();
    assert_int_equal(symlink("two", "other") | rename("other", "folder"), 0); /* a link on the way */
    assert_noticed();
    assert_true(watch_files("link", "link"));
    write_file("one/a");
    assert_false(file_watch_wait(watch, 20));
    write_file("two/a");
    assert_noticed();
    assert_int_equal(unlink("link") | symlink("one/a", "link"), 0);
    assert_noticed();
    watch_files("new/part/c", "link"); /* in folders that are to come */
    assert_int_equal(mkdir("new", 0777), 0);
    assert_noticed();
    watch_files("new/part/c", "link");
    assert_int_equal(mkdir("new/part", 0777), 0);
    assert_noticed();
    assert_true(watch_files("new/part/c", "link"));
    write_file("new/part/c");
    assert_noticed();
    assert_int_equal(rename("new", "old"), 0);
    watch_files("new/part/c", "link");
    assert_int_equal(rename("old", "new"), 0);
    assert_noticed();
    assert_int_equal(
        unlink("new/part/c") | rmdir("new/part") | rmdir("new") | unlink("one/a") | unlink("two/a"), 0);
}

/* A file that is open for writing counts as half written. */
static void half_written(void **state)
{
    (void)state;
    watch_files("a", "a");
    FILE *file = fopen("a", "w");
    assert_non_null(file);
    fputs("half", file);
    fflush(file);
    double written_ms = clock_ms();
    assert_true(file_watch_wait(watch, patience_ms));
    file_watch_settle(watch);
    assert_true(clock_ms() - written_ms > 190);
    fclose(file);
    assert_noticed();
}

/* More than inotify's queue holds: nobody knows what got lost. */
static void overflow(void **state)
{
    unsigned most = 16384;
    (void)state;
    watch_files("a", "a");
    FILE *file = fopen("/proc/sys/fs/inotify/max_queued_events", "r");
    if (!file || fscanf(file, "%u", &most) != 1 || most > 100000)
        skip();
    fclose(file);
    for (unsigned i = 0; i < most; ++i)
        close(open(i % 2 ? "b" : "c", O_WRONLY | O_CREAT, 0666));
    assert_noticed();
}

static int setup(void **state)
{
    return test_folder_setup(state) == 0 && file_watch_create(&watch) == STATUS_DONE ? 0 : -1;
}

static int teardown(void **state)
{
    file_watch_destroy(&watch);
    return test_folder_teardown(state);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(ways_of_saving), TEST(links_and_folders), TEST(half_written),
                                       TEST(overflow)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
