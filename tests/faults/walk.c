/* Has call after call of a program fail: walk LIBRARY CALL MOST PROGRAM ARGUMENT...
 *
 * In a new folder the program is run once as it is, then once for each of its calls, or for MOST of them,
 * spread evenly. Each time it must end with status 3 and an error message, or with 0 and the same files as
 * the first time; no file may be a part of one or a temporary one, and what the program allocated must be
 * freed. A crash in a library of the list below is told and counts as passed. LIBRARY is fail_calls.c. */
#include <dirent.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* What crashes when it has no memory: libfyaml in fy_parse_input_append() and others; the Vulkan loader and
 * lavapipe, with LLVM. */
static const char *const crashing[] = {"libfyaml", "libvulkan", "libLLVM", "libgallium", "libstdc++"};

enum { MOST_FILES = 8, MOST_MESSAGES = 1 << 16 };

static struct file {
    char name[64], *bytes;
    size_t size;
} good[MOST_FILES];
static size_t good_count;
static char folder[] = "/tmp/vkwhitted-faults-XXXXXX", messages[MOST_MESSAGES];
static char fail_variable[64], count_variable[] = "FAIL_COUNT=/proc/self/fd/13", preload_variable[4096];

static char *read_whole(const char *path, size_t *size)
{
    struct stat about;
    int file = open(path, O_RDONLY);
    if (file < 0 || fstat(file, &about) != 0)
        abort();
    char *bytes = calloc((size_t)about.st_size + 1, 1);
    if (!bytes || read(file, bytes, (size_t)about.st_size) != about.st_size)
        abort();
    *size = (size_t)about.st_size;
    close(file);
    return bytes;
}

/* Runs the program; its messages are kept, and how many calls and left allocations it counted. -1 and -1: it
 * did not get so far. */
static int run(char **program, long *calls, long *left)
{
    extern char **environ;
    char *environment[256] = {preload_variable, fail_variable, count_variable};
    size_t variables = 3;
    for (char **variable = environ; *variable && variables < 255; ++variable)
        environment[variables++] = *variable;
    int counts = memfd_create("counts", 0), told = memfd_create("messages", 0), outcome;
    pid_t process;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, counts, 13);
    posix_spawn_file_actions_adddup2(&actions, told, STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&process, program[0], &actions, NULL, program, environment) != 0 ||
        waitpid(process, &outcome, 0) != process)
        abort();
    posix_spawn_file_actions_destroy(&actions);
    char numbers[64] = "";
    *calls = *left = -1;
    if (pread(counts, numbers, sizeof numbers - 1, 0) > 0)
        sscanf(numbers, "%ld %ld", calls, left);
    ssize_t length = pread(told, messages, sizeof messages - 1, 0);
    messages[length > 0 ? length : 0] = '\0';
    close(counts);
    close(told);
    return outcome;
}

/* Calls act for each file of the folder; the first false ends it. */
static bool each_file(bool (*act)(const char *name))
{
    bool fine = true;
    DIR *entries = opendir(".");
    for (struct dirent *entry; fine && (entry = readdir(entries));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            fine = act(entry->d_name);
    closedir(entries);
    return fine;
}

static bool keep(const char *name)
{
    struct file *file = &good[good_count++];
    snprintf(file->name, sizeof file->name, "%s", name);
    file->bytes = read_whole(name, &file->size);
    return true;
}

static bool remove_file(const char *name)
{
    return unlink(name) == 0;
}

/* A JSON text has times in it, which differ, and an end. */
static bool is_whole(const char *name)
{
    size_t size;
    char *bytes = read_whole(name, &size);
    bool whole = false;
    for (size_t i = 0; i < good_count; ++i)
        if (strcmp(good[i].name, name) == 0)
            whole = strstr(name, ".json") ? size > 2 && strcmp(bytes + size - 2, "}\n") == 0
                                          : size == good[i].size && memcmp(bytes, good[i].bytes, size) == 0;
    if (!whole)
        fprintf(stderr, "%s is not what it should be\n", name);
    free(bytes);
    return whole;
}

static bool is_known_crash(void)
{
    const char *crash = strstr(messages, "crash in ");
    for (size_t i = 0; crash && i < sizeof crashing / sizeof *crashing; ++i)
        if (strncmp(crash + strlen("crash in "), crashing[i], strlen(crashing[i])) == 0) {
            printf("%s: %s", fail_variable, crash);
            return true;
        }
    return false;
}

static size_t files;
static bool count_file(const char *name)
{
    (void)name;
    ++files;
    return true;
}

static bool is_fine(int outcome, long left)
{
    if (!WIFEXITED(outcome))
        return is_known_crash();
    if (strstr(messages, "libgomp: Out of memory"))
        return true; /* it ends the process itself */
    files = 0;
    each_file(count_file);
    const int status = WEXITSTATUS(outcome);
    const char *problem = status != 0 && status != 3                    ? "another status"
                          : status == 3 && !strstr(messages, "error: ") ? "no message"
                          : status == 3 && strstr(fail_variable, "vulkan") && !strstr(messages, ": VK_ERROR_")
                              ? "no result"
                          : status == 0 && files != good_count ? "files are missing"
                          : left > 0                           ? "memory is not freed"
                          : !each_file(is_whole)               ? "a file"
                                                               : NULL;
    if (problem)
        fprintf(stderr, "%s: %s, status %d, %ld allocations left, said:\n%s", fail_variable, problem, status,
                left, messages);
    return !problem;
}

int main(int argc, char **argv)
{
    if (argc < 5)
        return 2;
    long calls, left, most = strtol(argv[3], NULL, 10), wrong = 0;
    snprintf(preload_variable, sizeof preload_variable, "LD_PRELOAD=%s", argv[1]);
    snprintf(fail_variable, sizeof fail_variable, "FAIL=%s:-1", argv[2]);
    if (!mkdtemp(folder) || chdir(folder) != 0)
        abort();
    int outcome = run(argv + 4, &calls, &left);
    each_file(keep);
    if (outcome != 0 || left != 0 || calls < 1) {
        fprintf(stderr, "as it is: outcome %d, %ld calls, %ld allocations left, said:\n%s", outcome, calls,
                left, messages);
        wrong = 1;
    }
    const long runs = calls < most ? calls : most;
    for (long i = 0; i < runs && !wrong; ++i) {
        each_file(remove_file);
        const long turn = i * calls / runs;
        snprintf(fail_variable, sizeof fail_variable, "FAIL=%s:%ld", argv[2], turn);
        outcome = run(argv + 4, &(long){0}, &left);
        if (!is_fine(outcome, left)) {
            fprintf(stderr, "%s: outcome %d, said:\n%s", fail_variable, outcome, messages);
            wrong += getenv("WALK_ON") ? 0 : 1;
        }
    }
    printf("%s: %ld of %ld calls failed\n", argv[2], runs, calls);
    each_file(remove_file);
    if (chdir("/") != 0 || rmdir(folder) != 0)
        perror(folder);
    return wrong != 0;
}
