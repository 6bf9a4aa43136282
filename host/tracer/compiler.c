#include "tracer/compiler.h"

#include <errno.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/interrupt.h"
#include "base/text_file.h"

/* What glslangValidator writes: files in memory, which it inherits and opens under their names. */
enum { LOG, SPIRV, DEPENDENCIES, FILES };

enum { MOST_FILE_BYTES = 1 << 26 };

/* Starts the glslangValidator of the build, whose SPIR-V is the build's, or else the one of PATH: "$0", the
 * log, its arguments. It needs 0.2 s, or a minute on a machine that is busy otherwise, and little memory. */
static const char script[] = "ulimit -S -c 0; ulimit -S -t 5; ulimit -S -v 1048576; ulimit -S -f 131072\n"
                             "log=$1; shift\n"
                             "[ -x \"$0\" ] && set -- \"$0\" \"$@\" || set -- glslangValidator \"$@\"\n"
                             "exec timeout --foreground 60 \"$@\" >\"$log\" 2>&1\n";

/* *outcome gets the wait status. */
static enum status run(const char *path, const char *const *options, char names[FILES][32], int *outcome)
{
    enum { CANNOT_RUN = 125 }; /* from there on, of the shell and timeout */
    const char *arguments[24] = {
        "sh",           "-c",        script,      GLSLANG_VALIDATOR,   names[LOG], "--quiet",   "-V",
        "--target-env", "vulkan1.2", "--depfile", names[DEPENDENCIES], "-o",       names[SPIRV]};
    size_t count = 13;
    pid_t process;
    if (SHADER_DEBUG_INFO)
        arguments[count++] = "-g";
    while (*options)
        arguments[count++] = *options++;
    arguments[count] = path;
    int error = posix_spawn(&process, "/bin/sh", NULL, NULL, (char *const *)arguments, environ);
    interrupt_ends(error == 0 ? process : 0);
    while (error == 0 && waitpid(process, outcome, 0) < 0)
        error = errno == EINTR ? 0 : errno;
    interrupt_ends(0);
    if (error == 0 && (!WIFEXITED(*outcome) || WEXITSTATUS(*outcome) < CANNOT_RUN))
        return STATUS_DONE;
    log_error("cannot start glslangValidator (of the package glslang-tools): %s",
              strerror(error ? error : ENOENT));
    return STATUS_UNABLE;
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

/* Skips the prefix where the text begins with it. */
static bool skip(char **text, const char *prefix)
{
    size_t length = strlen(prefix);
    bool has = strncmp(*text, prefix, length) == 0;
    *text += has ? length : 0;
    return has;
}

/* Writes a message as compilers do, without the noise in which glslang wraps it; and the files that it names,
 * a missing one beside the one that includes it. */
static void put_message(FILE *messages, FILE *files, const char *path, const char *severity, char *text)
{
    char *colon = strchr(text, ':');
    while (colon && strspn(colon + 1, "0123456789") == 0)
        colon = strchr(colon + 1, ':');
    char *end = colon ? strstr(colon + 1, ": ") : NULL;
    if (end) {
        path = text;
        text = end + 2;
        *end = 0;
    }
    fprintf(messages, "%s: %s: ", path, severity);
    if (end) {
        *colon = 0;
        fprintf(files, "%s%c", path, 0);
    }
    skip(&text, "'' :");
    if (skip(&text, "'#include' : Could not process include directive for header name: ")) {
        const char *slash = strrchr(path, '/');
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
    bool failed = false;
    char *rest, *first = strtok_r(log, "\n", &rest);
    for (char *line = first; line && !failed; line = strtok_r(NULL, "\n", &rest)) {
        failed = skip(&line, "ERROR: ");
        if (failed || skip(&line, "WARNING: "))
            put_message(messages, files, path, failed ? "error" : "warning", line);
    }
    if (WIFSIGNALED(outcome))
        fprintf(messages, "%s: error: glslangValidator ended early: %s\n", path,
                strsignal(WTERMSIG(outcome)));
    else if (outcome != 0 && !failed)
        fprintf(messages, "%s: error: %s\n", path, first ? first : "glslangValidator failed");
}

static enum status take_result(const char *path, char names[FILES][32], int outcome,
                               struct compilation *compilation)
{
    size_t size;
    FILE *messages = open_memstream(&compilation->messages, &size);
    FILE *files = open_memstream(&compilation->files, &size);
    char *log = text_file_read(names[LOG], true, MOST_FILE_BYTES, &size);
    char *dependencies = text_file_read(names[DEPENDENCIES], true, MOST_FILE_BYTES, &size);
    bool complete = messages && files && log && dependencies;
    if (complete) {
        put_messages(messages, files, path, log, outcome);
        put_dependencies(files, dependencies);
        fprintf(files, "%c%c", 0, 0);
    }
    complete = messages && fclose(messages) == 0 && complete;
    complete = files && fclose(files) == 0 && complete;
    free(log);
    free(dependencies);
    if (complete && outcome != 0)
        return STATUS_REFUSED;
    compilation->words = (void *)text_file_read(names[SPIRV], true, MOST_FILE_BYTES, &compilation->size);
    if (complete && compilation->words && compilation->size > 0)
        return STATUS_DONE;
    log_error("no memory for a compiled shader");
    return STATUS_UNABLE;
}

enum status shader_compile(const char *path, const char *const *options, struct compilation *compilation)
{
    int files[FILES], outcome = -1;
    char names[FILES][32];
    bool created = true;
    *compilation = (struct compilation){0};
    for (int i = 0; i < FILES; ++i) {
        created = (files[i] = memfd_create("glslangValidator", 0)) >= 0 && created;
        snprintf(names[i], sizeof names[i], "/dev/fd/%d", files[i]);
    }
    if (!created)
        log_error("cannot compile the shader: %s", strerror(errno));
    enum status status = created ? run(path, options, names, &outcome) : STATUS_UNABLE;
    if (status == STATUS_DONE)
        status = take_result(path, names, outcome, compilation);
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
