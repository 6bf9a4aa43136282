#include "watch/shader_compiler.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/interrupt.h"
#include "watch/glslang_compile.h"

struct shader_compiler {
    pid_t server;
    int socket;
    struct glslang_job *job; /* shared with the server and its children */
};

/* Compiles in a child for each request, so that glslang is initialised once. Answers with the child's wait
 * status, or -1 where there was none. */
static _Noreturn void serve(int socket, struct glslang_job *job)
{
    char request;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setpgid(0, 0); /* Ctrl-C is for the program alone */
    glslang_warm_up(job);
    while (read(socket, &request, 1) == 1) {
        pid_t child = fork();
        if (child == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            glslang_limit();
            glslang_run(job);
            _exit(0);
        }
        int outcome = -1;
        while (child > 0 && waitpid(child, &outcome, 0) < 0 && errno == EINTR)
            ;
        if (write(socket, &outcome, sizeof outcome) != sizeof outcome)
            break;
    }
    _exit(0);
}

enum status shader_compiler_create(struct shader_compiler **pointer)
{
    int sockets[2] = {-1, -1};
    struct shader_compiler *compiler = *pointer = calloc(1, sizeof *compiler);
    if (!compiler) {
        log_error("no memory for the shader compiler");
        return STATUS_UNABLE;
    }
    compiler->socket = -1;
    compiler->job = mmap(NULL, sizeof *compiler->job, PROT_READ | PROT_WRITE,
                         MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (compiler->job == MAP_FAILED)
        compiler->job = NULL;
    else if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) == 0)
        compiler->server = fork();
    if (sockets[0] >= 0 && compiler->server == 0) {
        close(sockets[0]);
        serve(sockets[1], compiler->job);
    }
    if (sockets[1] >= 0)
        close(sockets[1]);
    compiler->socket = sockets[0];
    if (compiler->server > 0)
        return STATUS_DONE;
    log_error("cannot start the shader compiler: %s", strerror(errno));
    shader_compiler_destroy(pointer);
    return STATUS_UNABLE;
}

void shader_compiler_destroy(struct shader_compiler **pointer)
{
    struct shader_compiler *compiler = *pointer;
    *pointer = NULL;
    if (!compiler)
        return;
    if (compiler->server > 0) {
        kill(compiler->server, SIGKILL);
        while (waitpid(compiler->server, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    if (compiler->socket >= 0)
        close(compiler->socket);
    if (compiler->job)
        munmap(compiler->job, sizeof *compiler->job);
    free(compiler);
}

/* Waits for the server's answer, and hears Ctrl-C meanwhile. */
static enum status await(struct shader_compiler *compiler, int *outcome)
{
    struct pollfd readable = {.fd = compiler->socket, .events = POLLIN};
    while (poll(&readable, 1, 100) <= 0)
        if (interrupt_requested())
            return STATUS_INTERRUPTED;
    ssize_t got = recv(compiler->socket, outcome, sizeof *outcome, MSG_WAITALL);
    if (got == sizeof *outcome && *outcome != -1)
        return STATUS_DONE;
    log_error("the shader compiler's process %s", got > 0 ? "could not start another one" : "has ended");
    return STATUS_UNABLE;
}

static const char *name_of_crash(int signal_number)
{
    switch (signal_number) {
    case SIGXCPU:
        return "ERROR: glslang has not come to an end\n";
    case SIGABRT:
        return "ERROR: glslang gave up: aborted, or out of memory\n";
    default:
        return "ERROR: glslang crashed on this shader\n";
    }
}

static enum status take_result(const struct glslang_job *job, const struct shader_source *source, int outcome,
                               struct compilation *compilation)
{
    bool ended = WIFEXITED(outcome) && WEXITSTATUS(outcome) == 0;
    const char *log = ended                  ? job->log
                      : WIFSIGNALED(outcome) ? name_of_crash(WTERMSIG(outcome))
                                             : "ERROR: glslang ended early\n";
    bool compiled = ended && job->word_count > 0;
    compilation->messages = shader_source_messages(source, log);
    compilation->size = compiled ? job->word_count * sizeof *job->words : 0;
    compilation->words = compiled ? malloc(compilation->size) : NULL;
    if (compilation->messages && (!compiled || compilation->words)) {
        if (compiled)
            memcpy(compilation->words, job->words, compilation->size);
        return compiled ? STATUS_DONE : STATUS_REFUSED;
    }
    log_error("no memory for a compiled shader");
    compilation_destroy(compilation);
    return STATUS_UNABLE;
}

enum status shader_compile(struct shader_compiler *compiler, const struct shader_source *source,
                           const char *defines, struct compilation *compilation)
{
    struct glslang_job *job = compiler->job;
    int outcome;
    *compilation = (struct compilation){0};
    if (source->length >= sizeof job->source) {
        log_error("%s: the shader is too long", source->files[0]);
        return STATUS_UNABLE;
    }
    memcpy(job->source, source->text, source->length + 1);
    snprintf(job->defines, sizeof job->defines, "%s", defines);
    if (send(compiler->socket, "", 1, MSG_NOSIGNAL) != 1) {
        log_error("the shader compiler's process has ended");
        return STATUS_UNABLE;
    }
    enum status status = await(compiler, &outcome);
    return status == STATUS_DONE ? take_result(job, source, outcome, compilation) : status;
}

void compilation_destroy(struct compilation *compilation)
{
    free(compilation->words);
    free(compilation->messages);
    *compilation = (struct compilation){0};
}
