#ifndef VKWHITTED_TRACER_SHADER_FOLDER_H
#define VKWHITTED_TRACER_SHADER_FOLDER_H

#include <limits.h>

#include "tracer/compiler.h"
#include "tracer/interface.h"

/* The path of the folder's whitted.comp. STATUS_REFUSED (reported) where it cannot be read. */
enum status shader_path(const char *folder, char path[static PATH_MAX]);

/* Compiles a variant of the shader as shader_compile() does, and refuses it too where it does not obey the
 * rules (see shader_rules.h), with the line. The path is that of a whitted.comp. */
enum status shader_build(const char *path, struct shader_choice choice, struct compilation *compilation);

/* The options with which the build has glslangValidator compile the variant; NULL behind the last. */
enum { MOST_DEFINES = 4 };
void shader_defines(struct shader_choice choice, const char *defines[static MOST_DEFINES]);

/* A folder with a whitted.comp in the place of the program's own, and what has been compiled of it. */
struct shader_folder {
    const char *path;
    struct compilation compiled[WHITTED_VARIANTS][2]; /* empty: not yet; [1]: the scene in storage buffers */
};

/* The code of the variant, in the folder's memory; it is compiled when it is asked for first. Messages of the
 * compiler go to standard error then. Any other status than STATUS_DONE has been reported, once. */
enum status shader_folder_code(struct shader_folder *folder, struct shader_choice choice, struct spirv *code);

/* Frees what has been compiled. */
void shader_folder_destroy(struct shader_folder *folder);

#endif
