#ifndef VKWHITTED_WATCH_SHADER_SOURCE_H
#define VKWHITTED_WATCH_SHADER_SOURCE_H

#include <stddef.h>

#include "base/status.h"

/* A shader with its #include directives replaced by what they name. Each included text stands between #line
 * directives whose string number is the index in `files`, so that the compiler's messages lead back to the
 * file. What cannot be included becomes an #error where the directive stands: it counts only where the
 * preprocessor comes by. */
struct shader_source {
    char *text; /* ends with 0 */
    size_t length;
    char **files; /* paths: the shader itself, then what it includes, also where that is missing */
    size_t file_count;
    char **problems; /* what the #errors mean that are not the shader's own */
    size_t problem_count;
};

/* Expands the shader at path. Included files are looked for in the folder of the file that names them, then
 * in the folders of those that include it. A shader that cannot be read becomes an #error, too. STATUS_UNABLE
 * (reported) without memory: *source is empty then. The caller frees *source. */
enum status shader_source_read(const char *path, struct shader_source *source);
void shader_source_destroy(struct shader_source *source);

/* glslang's messages about the source, with "path:line: error: ..." for "ERROR: string:line: ..."; the caller
 * frees them. NULL without memory. */
char *shader_source_messages(const struct shader_source *source, const char *log);

#endif
