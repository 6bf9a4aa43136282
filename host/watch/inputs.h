#ifndef VKWHITTED_WATCH_INPUTS_H
#define VKWHITTED_WATCH_INPUTS_H

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* What a picture is made of: the scene, the files with spheres that it names, and the files that the shader
 * was compiled from last. As long as the shader does not compile, also all other *.comp, *.glsl and *.h in
 * its folder: a change there may be what mends it. */
enum input_kind { INPUT_SCENE, INPUT_SPHERES, INPUT_SHADER, INPUT_KINDS };

/* A hash of the names, identities, sizes and times of the files of each kind: when it changes, they have. */
struct inputs_state {
    uint64_t of[INPUT_KINDS];
};

struct inputs {
    const char *scene_path; /* the caller's */
    char shader_path[PATH_MAX];
    char *files[INPUT_KINDS]; /* other files: paths, each ended by a 0, and the list by another 0; or NULL */
    bool shader_broken;
    struct inputs_state taken; /* when inputs_take() was last true */
    struct inputs_state seen;  /* when the files were last looked at */
    double last_look_ms, unchanged_since_ms, saved_ms;
};

/* The shader is whitted.comp in that folder, or where that is NULL, in the one that was installed with the
 * program or, for a program that is not installed, in the source tree. A file that is missing now is a
 * mistake on the command line, not one to be corrected in an editor: STATUS_REFUSED (reported). */
enum status inputs_create(const char *scene_path, const char *shader_folder, struct inputs *inputs);
void inputs_destroy(struct inputs *inputs);

/* Looks at the files; to be called every 20 ms or so. True if they have changed since they were last taken,
 * and are complete: nothing has changed for a moment, nobody is writing as far as can be known, and whatever
 * is written from now on will get another time. They count as taken then, and *saved_ms is when they were
 * saved, by clock_ms(). */
bool inputs_take(struct inputs *inputs, double *saved_ms);

/* The scene file's text, to be freed by the caller; NULL (reported) and errno where it cannot be read. */
char *inputs_read_scene(const struct inputs *inputs, size_t *length);

/* Whether the files are as they were when they were taken. To be asked after they have been read: if they are
 * not, what was read may be half a file, and they will be taken again. */
bool inputs_hold(const struct inputs *inputs);

/* Replaces the other files of this kind by these, whose list (as above) was the caller's; *files becomes
 * NULL. To be called while inputs_hold() is true: for spheres before they are read, for the shader after it
 * has been compiled and shader_broken has been set. True if the files are complete, and older than what was
 * taken; otherwise all will be taken again. */
bool inputs_follow(struct inputs *inputs, enum input_kind kind, char **files);

#endif
