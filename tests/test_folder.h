#ifndef VKWHITTED_TEST_FOLDER_H
#define VKWHITTED_TEST_FOLDER_H

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A folder of a test's own, which is its working directory from setup to teardown. */
static char test_folder[] = "/tmp/vkwhitted-test-XXXXXX";

static inline int test_folder_setup(void **state)
{
    (void)state;
    strcpy(test_folder + sizeof test_folder - sizeof "XXXXXX", "XXXXXX");
    return mkdtemp(test_folder) && chdir(test_folder) == 0 ? 0 : -1;
}

/* The files there (or 0), each removed when remove_them is set; so are empty folders. */
static inline int test_folder_files(int remove_them)
{
    int count = 0;
    DIR *folder = opendir(test_folder);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        count++;
        if (remove_them && unlinkat(dirfd(folder), entry->d_name, 0) != 0)
            unlinkat(dirfd(folder), entry->d_name, AT_REMOVEDIR);
    }
    if (folder)
        closedir(folder);
    return count;
}

static inline int test_folder_teardown(void **state)
{
    (void)state;
    test_folder_files(1);
    return chdir("/") == 0 && rmdir(test_folder) == 0 ? 0 : -1;
}

static inline void test_write_file(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    if (!stream || fwrite(bytes, 1, size, stream) != size || fclose(stream) != 0)
        abort();
}

/* A test that runs in such a folder. */
#define TEST_IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_folder_setup, test_folder_teardown)

/* Standard error goes into a pipe (64 KiB at most) between the two; the second returns how many lines were
 * written, which are in test_messages then, and puts the first of them (as much as fits) into line. */
static int test_messages_fd, test_saved_stderr;
static char test_messages[1 << 16];

static inline void test_messages_begin(void)
{
    fflush(stderr);
    test_saved_stderr = dup(STDERR_FILENO);
    int ends[2];
    if (test_saved_stderr < 0 || pipe2(ends, O_NONBLOCK) != 0)
        abort();
    test_messages_fd = ends[0];
    dup2(ends[1], STDERR_FILENO);
    close(ends[1]);
}

static inline int test_messages_end(char line[256])
{
    fflush(stderr);
    dup2(test_saved_stderr, STDERR_FILENO);
    close(test_saved_stderr);
    ssize_t length = read(test_messages_fd, test_messages, sizeof test_messages - 1);
    close(test_messages_fd);
    test_messages[length > 0 ? length : 0] = '\0';
    snprintf(line, 256, "%.*s", (int)strcspn(test_messages, "\n"), test_messages);
    int lines = 0;
    for (const char *end = test_messages; (end = strchr(end, '\n')); end++)
        lines++;
    return lines;
}

#endif
