#ifndef VKWHITTED_WATCH_SHADER_COMPILER_H
#define VKWHITTED_WATCH_SHADER_COMPILER_H

#include "tracer/whitted_spirv.h"
#include "watch/shader_source.h"

/* glslang in a process of its own, so that a shader that crashes it costs nothing but that compilation. */
struct shader_compiler;

/* Starts the process, with no other threads running yet. On failure (reported) *compiler is NULL. */
enum status shader_compiler_create(struct shader_compiler **compiler);
void shader_compiler_destroy(struct shader_compiler **compiler);

struct compilation {
    uint32_t *words; /* NULL: it failed */
    size_t size;     /* bytes */
    char *messages;  /* errors and warnings, as shader_source_messages() writes them */
};

/* Compiles a compute shader as the build does, the defines (see whitted_defines()) before its first line.
 * STATUS_DONE with words and possibly warnings, or STATUS_REFUSED with messages and nothing reported;
 * otherwise STATUS_UNABLE (reported) or STATUS_INTERRUPTED. The caller destroys the compilation. */
enum status shader_compile(struct shader_compiler *compiler, const struct shader_source *source,
                           const char *defines, struct compilation *compilation);
void compilation_destroy(struct compilation *compilation);

#endif
