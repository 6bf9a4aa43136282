#include "tracer/shader_folder.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text_file.h"
#include "tracer/shader_rules.h"

void shader_defines(struct shader_choice choice, const char *defines[static MOST_DEFINES])
{
    static const char *const arithmetic[] = {"-DEXACT", "-DCORRECTED", "-DDOUBLE", "-DFAST"};
    const bool events = choice.variant >= WHITTED_EXACT_EVENTS;
    *defines++ = arithmetic[events ? choice.variant - WHITTED_EXACT_EVENTS : choice.variant];
    if (events)
        *defines++ = "-DTRACE_EVENTS";
    if (choice.scene_in_storage)
        *defines++ = "-DSCENE_IN_STORAGE";
    *defines = NULL;
}

enum status shader_path(const char *folder, char path[static PATH_MAX])
{
    errno = ENAMETOOLONG;
    const bool fits = snprintf(path, PATH_MAX, "%s/whitted.comp", folder) < PATH_MAX;
    const int file = fits ? input_file_open(path, true) : -1;
    if (file >= 0) {
        close(file);
        return STATUS_DONE;
    }
    const int error = errno;
    log_error("%s: %s; --shaders names the folder of whitted.comp", path, input_file_problem(error));
    return input_file_status(error);
}

/* Adds the problem to the messages. */
static enum status refuse(const char *path, const struct shader_problem *problem,
                          struct compilation *compilation)
{
    char *warnings = compilation->messages, line[16] = "";
    if (problem->file)
        snprintf(line, sizeof line, ":%u", problem->line);
    const int length = asprintf(&compilation->messages, "%s%s%s: error: %s\n", warnings,
                                problem->file ? problem->file : path, line, problem->text);
    free(warnings);
    free(compilation->words); /* the problem's file lay in them */
    compilation->words = NULL;
    if (length >= 0)
        return STATUS_REFUSED;
    log_error("no memory for a message");
    compilation->messages = NULL;
    compilation_destroy(compilation);
    return STATUS_UNABLE;
}

enum status shader_build(const char *path, struct shader_choice choice, struct compilation *compilation)
{
    const char *options[1 + MOST_DEFINES] = {"-g"};
    struct shader_problem problem;
    shader_defines(choice, options + 1);
    enum status status = shader_compile(path, options + 1, compilation);
    if (status != STATUS_DONE ||
        shader_obeys((struct spirv){compilation->words, compilation->size}, choice, &problem))
        return status;
    compilation_destroy(compilation); /* and once more, with lines */
    status = shader_compile(path, options, compilation);
    if (status != STATUS_DONE ||
        shader_obeys((struct spirv){compilation->words, compilation->size}, choice, &problem))
        return status; /* the file has just been changed */
    return refuse(path, &problem, compilation);
}

enum status shader_folder_code(struct shader_folder *folder, struct shader_choice choice, struct spirv *code)
{
    struct compilation *compiled = &folder->compiled[choice.variant][choice.scene_in_storage];
    char path[PATH_MAX];
    enum status status = compiled->words ? STATUS_DONE : STATUS_REFUSED;
    if (!compiled->messages) {
        status = shader_path(folder->path, path);
        if (status == STATUS_DONE)
            status = shader_build(path, choice, compiled);
        if (compiled->messages)
            fputs(compiled->messages, stderr);
    }
    *code = (struct spirv){compiled->words, compiled->size};
    return status;
}

void shader_folder_destroy(struct shader_folder *folder)
{
    for (int variant = 0; variant < WHITTED_VARIANTS; ++variant)
        for (int storage = 0; storage < 2; ++storage)
            compilation_destroy(&folder->compiled[variant][storage]);
}
