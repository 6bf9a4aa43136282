#include "bench/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/interrupt.h"

extern char **environ;

static enum status report(const char *what, int error)
{
    log_error("gnuplot, which draws the charts of a report: %s: %s%s", what, strerror(error),
              error == ENOENT ? " (Debian has it in the package gnuplot-nox)" : "");
    return STATUS_UNABLE;
}

/* Starts gnuplot with input as its standard input; *output gets the reading end of its standard output.
 * An errno, or 0. */
static int start(char *const *arguments, int input, int *output, pid_t *pid)
{
    int ends[2];
    posix_spawn_file_actions_t actions;
    if (pipe2(ends, O_CLOEXEC) != 0)
        return errno;
    int error = posix_spawn_file_actions_init(&actions);
    if (error == 0) {
        error = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
        if (error == 0)
            error = posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        if (error == 0)
            error = posix_spawnp(pid, arguments[0], &actions, NULL, arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    close(ends[1]);
    if (error != 0)
        close(ends[0]);
    *output = ends[0];
    return error;
}

/* All that can be read, with a 0 at its end, or NULL and errno. */
static char *read_all(int fd)
{
    size_t size = 0, room = 1 << 16;
    char *text = malloc(room);
    while (text) {
        ssize_t got = read(fd, text + size, room - size - 1);
        if (got == 0) {
            text[size] = '\0';
            break;
        }
        if (got < 0 && errno == EINTR)
            continue;
        size += got > 0 ? (size_t)got : 0;
        char *larger = got < 0 ? NULL : size + 1 < room ? text : realloc(text, room *= 2);
        if (!larger)
            free(text);
        text = larger;
    }
    return text;
}

static enum status wait_for(pid_t pid)
{
    int result;
    while (waitpid(pid, &result, 0) < 0)
        if (errno != EINTR)
            return report("cannot wait for it", errno);
    if (WIFEXITED(result) && WEXITSTATUS(result) == 0)
        return STATUS_DONE;
    if (interrupt_requested())
        return STATUS_INTERRUPTED;
    log_error("gnuplot, which draws the charts of a report, ended with %s %d",
              WIFEXITED(result) ? "exit status" : "signal",
              WIFEXITED(result) ? WEXITSTATUS(result) : WTERMSIG(result));
    return STATUS_UNABLE;
}

/* *output is what gnuplot printed; the caller frees it. */
static enum status run(char *const *arguments, const char *script, char **output)
{
    *output = NULL;
    /* A file, not a pipe: nobody has to write while somebody else reads. */
    FILE *input = tmpfile();
    if (!input)
        return report("cannot create a temporary file", errno);
    bool written = fputs(script, input) >= 0 && fflush(input) == 0 && fseek(input, 0, SEEK_SET) == 0;
    int error = written ? 0 : errno ? errno : EIO, printed = -1;
    pid_t pid;
    if (error == 0)
        error = start(arguments, fileno(input), &printed, &pid);
    fclose(input);
    if (error != 0)
        return report("cannot run it", error);
    *output = read_all(printed);
    error = errno;
    close(printed);
    enum status status = wait_for(pid);
    if (status == STATUS_DONE && !*output)
        status = report("cannot read what it prints", error);
    if (status != STATUS_DONE) {
        free(*output);
        *output = NULL;
    }
    return status;
}

enum status gnuplot_check(void)
{
    char *output;
    enum status status = run((char *[]){"gnuplot", "--version", NULL}, "", &output);
    free(output);
    return status;
}

/* Copies the text from start to end, with the prefix before each id and each reference to one, without what
 * gnuplot calls its curves. */
static void copy_prefixed(const char *start, const char *end, const char *prefix, FILE *out)
{
    static const char *const before_ids[] = {" id=\"", " id='", "href='#", "href=\"#", "url(#"};
    while (start < end) {
        const char *title_end =
            strncmp(start, "<title>", strlen("<title>")) == 0 ? strstr(start, "</title>") : NULL;
        if (title_end) {
            start = title_end + strlen("</title>");
            continue;
        }
        size_t length = 0;
        for (size_t i = 0; i < sizeof before_ids / sizeof before_ids[0] && length == 0; i++)
            if (strncmp(start, before_ids[i], strlen(before_ids[i])) == 0)
                length = strlen(before_ids[i]);
        fwrite(start, 1, length > 0 ? length : 1, out);
        if (length > 0)
            fputs(prefix, out);
        start += length > 0 ? length : 1;
    }
}

enum status gnuplot_draw(const char *script, const char *id_prefix, FILE *out)
{
    char *output;
    enum status status = run((char *[]){"gnuplot", "-d", "-", NULL}, script, &output);
    if (status != STATUS_DONE)
        return status;
    const char *start = strstr(output, "<g id=\"gnuplot_canvas\">"), *end = strstr(output, "</svg>");
    if (start && end && start < end) {
        copy_prefixed(start, end, id_prefix, out);
    } else {
        log_error("gnuplot, which draws the charts of a report, has drawn no SVG that this program knows");
        status = STATUS_UNABLE;
    }
    free(output);
    return status;
}
