#ifndef VKWHITTED_TRACER_COMPILER_H
#define VKWHITTED_TRACER_COMPILER_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct compilation {
    uint32_t *words; /* SPIR-V; NULL: the shader does not compile */
    size_t size;     /* bytes */
    char *messages;  /* lines like "path:line: error: ...": the first error, and warnings */
    char *files;     /* paths of what it was compiled from, or after an error, of what the messages name; a 0
                        behind each, and an empty one behind the last */
};

/* Compiles a compute shader with glslangValidator, in a process of its own, which may crash. The options,
 * NULL behind the last, come behind the build's.
 *
 * STATUS_DONE, or STATUS_REFUSED where the shader does not compile, nothing being reported: the caller prints
 * the messages. Otherwise STATUS_UNABLE (reported), and the compilation is empty. The
 * caller destroys it. */
enum status shader_compile(const char *path, const char *const *options, struct compilation *compilation);
void compilation_destroy(struct compilation *compilation);

#endif
