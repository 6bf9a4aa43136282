#include "watch/compiler.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/pidfd.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/interrupt.h"

enum {
    MOST_CPU_SECONDS = 5, /* it takes 0.2 */
    MOST_MEMORY_BYTES = 1 << 30,
    MOST_FILE_BYTES = 1 << 26,
};
static const double most_ms = 60000; /* on a machine that is busy otherwise */

/* What glslangValidator writes: files in memory, which it inherits and opens under their numbers. */
enum { LOG, SPIRV, DEPENDENCIES, FILES };

/* Starts the glslangValidator of the build, whose SPIR-V is the build's, or else the one of PATH. Returns
 * what posix_spawn() does. */
static int spawn(const int files[FILES], char *const *arguments, pid_t *process)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    for (int i = SPIRV; i < FILES; ++i) /* onto itself: inherited */
        posix_spawn_file_actions_adddup2(&actions, files[i], files[i]);
    posix_spawn_file_actions_adddup2(&actions, files[LOG], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, files[LOG], STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP); /* Ctrl-C is for this program alone */
    int error = posix_spawn(process, GLSLANG_VALIDATOR, &actions, &attributes, arguments, environ);
    if (error == ENOENT)
        error = posix_spawnp(process, "glslangValidator", &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

/* Waits for its end, which comes soon where it takes too long, and after Ctrl-C. Returns the wait status. */
static int await(pid_t process)
{
    const struct {
        int resource;
        rlim_t most;
    } limits[] = {{RLIMIT_CPU, MOST_CPU_SECONDS},
                  {RLIMIT_AS, MOST_MEMORY_BYTES},
                  {RLIMIT_FSIZE, MOST_FILE_BYTES},
                  {RLIMIT_CORE, 0}};
    struct pollfd ended = {.fd = pidfd_open(process, 0), .events = POLLIN};
    double end_ms = clock_ms() + most_ms;
    int outcome = -1;
    for (size_t i = 0; i < sizeof limits / sizeof *limits; ++i)
        prlimit(process, limits[i].resource, &(struct rlimit){limits[i].most, limits[i].most + 1}, NULL);
    while (ended.fd >= 0 && poll(&ended, 1, 100) <= 0)
        if (interrupt_requested() || clock_ms() > end_ms)
            kill(process, SIGKILL);
    if (ended.fd >= 0)
        close(ended.fd);
    while (waitpid(process, &outcome, 0) < 0 && errno == EINTR)
        ;
    return outcome;
}

/* *outcome gets the wait status. */
static enum status run(const char *path, const char *const *options, const int files[FILES], int *outcome)
{
    const char *arguments[16] = {"glslangValidator", "--quiet", "-V", "--target-env", "vulkan1.2"};
    char spirv[32], dependencies[32];
    size_t count = 5;
    pid_t process;
    snprintf(spirv, sizeof spirv, "/dev/fd/%d", files[SPIRV]);
    snprintf(dependencies, sizeof dependencies, "/dev/fd/%d", files[DEPENDENCIES]);
    if (SHADER_DEBUG_INFO)
        arguments[count++] = "-g";
    while (*options)
        arguments[count++] = *options++;
    memcpy(arguments + count, (const char *[]){"--depfile", dependencies, "-o", spirv, path},
           5 * sizeof *arguments);
    int error = spawn(files, (char *const *)arguments, &process);
    if (error == 0)
        *outcome = await(process);
    else
        log_error("cannot start glslangValidator (of the package glslang-tools): %s", strerror(error));
    return interrupt_requested() ? STATUS_INTERRUPTED : error == 0 ? STATUS_DONE : STATUS_UNABLE;
}

/* The file's bytes with a 0 behind them, to be freed by the caller; NULL without memory. */
static void *read_all(int file, size_t *size)
{
    off_t end = lseek(file, 0, SEEK_END);
    char *bytes = calloc(1, (size_t)end + 1);
    ssize_t got = bytes ? pread(file, bytes, (size_t)end, 0) : 0;
    *size = got > 0 ? (size_t)got : 0;
    return bytes;
}

/* Takes the paths from what --depfile has written, "output: path path ...", with a \ before a blank in one.
 */
static void put_dependencies(FILE *files, const char *text)
{
    const char *at = strstr(text, ": ");
    for (at = at ? at + 2 : ""; *at && *at != '\n'; ++at) {
        bool escaped = at[0] == '\\' && at[1] == ' ';
        at += escaped;
        fputc(*at == ' ' && !escaped ? 0 : *at, files);
    }
}

/* Writes a message as compilers do, without the noise in which glslang wraps it; and the files that it names,
 * a missing one beside the one that includes it. */
static void put_message(FILE *messages, FILE *files, const char *path, const char *severity, char *message)
{
    static const char missing[] = "'#include' : Could not process include directive for header name: ",
                      unnamed[] = "'' :";
    char *colon = strchr(message, ':'), *text = message;
    while (colon && strspn(colon + 1, "0123456789") == 0)
        colon = strchr(colon + 1, ':');
    if (colon && (text = strstr(colon + 1, ": "))) {
        path = message;
        *colon = *text = 0;
        fprintf(messages, "%s:%s: %s: ", path, colon + 1, severity);
        fprintf(files, "%s%c", path, 0);
        text += 2;
    } else {
        text = message;
        fprintf(messages, "%s: %s: ", path, severity);
    }
    if (strncmp(text, unnamed, sizeof unnamed - 1) == 0)
        text += sizeof unnamed - 1;
    if (strncmp(text, missing, sizeof missing - 1) == 0) {
        const char *slash = strrchr(path, '/');
        text += sizeof missing - 1;
        fprintf(messages, "cannot include ");
        fprintf(files, "%.*s%s%c", slash && *text != '/' ? (int)(slash + 1 - path) : 0, path, text, 0);
    }
    text += strspn(text, " ");
    for (size_t length = strlen(text); length > 0 && text[length - 1] == ' ';)
        text[--length] = 0;
    fprintf(messages, "%s\n", text);
}

/* Warnings and the first error: glslang reads no further then, and what else it says is a consequence. */
static void put_messages(FILE *messages, FILE *files, const char *path, char *log, int outcome)
{
    static const char error[] = "ERROR: ", warning[] = "WARNING: ";
    bool failed = false;
    char *rest, *first = strtok_r(log, "\n", &rest);
    for (char *line = first; line && !failed; line = strtok_r(NULL, "\n", &rest)) {
        failed = strncmp(line, error, sizeof error - 1) == 0;
        if (failed)
            put_message(messages, files, path, "error", line + sizeof error - 1);
        else if (strncmp(line, warning, sizeof warning - 1) == 0)
            put_message(messages, files, path, "warning", line + sizeof warning - 1);
    }
    if (WIFSIGNALED(outcome))
        fprintf(messages, "%s: error: glslangValidator ended early: %s\n", path,
                strsignal(WTERMSIG(outcome)));
    else if (outcome != 0 && !failed)
        fprintf(messages, "%s: error: %s\n", path, first ? first : "glslangValidator failed");
}

static enum status take_result(const char *path, const int files[FILES], int outcome,
                               struct compilation *compilation)
{
    size_t size;
    FILE *messages = open_memstream(&compilation->messages, &size);
    FILE *paths = open_memstream(&compilation->files, &size);
    char *log = read_all(files[LOG], &size), *dependencies = read_all(files[DEPENDENCIES], &size);
    bool compiled = outcome == 0, complete = messages && paths && log && dependencies;
    if (complete) {
        put_messages(messages, paths, path, log, outcome);
        put_dependencies(paths, dependencies);
        fputc(0, paths);
        fputc(0, paths);
    }
    complete = messages && fclose(messages) == 0 && complete;
    complete = paths && fclose(paths) == 0 && complete;
    free(log);
    free(dependencies);
    if (compiled)
        compilation->words = read_all(files[SPIRV], &compilation->size);
    if (complete && (!compiled || compilation->size > 0))
        return compiled ? STATUS_DONE : STATUS_REFUSED;
    log_error("no memory for a compiled shader");
    return STATUS_UNABLE;
}

enum status shader_compile(const char *path, const char *const *options, struct compilation *compilation)
{
    int files[FILES], outcome = -1;
    bool created = true;
    *compilation = (struct compilation){0};
    for (int i = 0; i < FILES; ++i)
        created = (files[i] = memfd_create("glslangValidator", MFD_CLOEXEC)) >= 0 && created;
    if (!created)
        log_error("cannot compile the shader: %s", strerror(errno));
    enum status status = created ? run(path, options, files, &outcome) : STATUS_UNABLE;
    if (status == STATUS_DONE)
        status = take_result(path, files, outcome, compilation);
    for (int i = 0; i < FILES; ++i)
        if (files[i] >= 0)
            close(files[i]);
    if (status != STATUS_DONE && status != STATUS_REFUSED)
        compilation_destroy(compilation);
    return status;
}

void compilation_destroy(struct compilation *compilation)
{
    free(compilation->words);
    free(compilation->messages);
    free(compilation->files);
    *compilation = (struct compilation){0};
}
