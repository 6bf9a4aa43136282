#ifndef VKWHITTED_WATCH_INPUTS_H
#define VKWHITTED_WATCH_INPUTS_H

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* The state of files, as stat() tells it, in a number: another one, other files. */
struct inputs_state {
    uint64_t scene, spheres, shader;
};

/* The files that a picture is made of: the scene, those with spheres that it names, and what the shader was
 * compiled from last; as long as that does not compile also what else of *.comp, *.glsl and *.h lies in its
 * folder, for that may be what mends it. */
struct inputs {
    const char *scene_path; /* the caller's */
    char *sphere_files;     /* as scene_list_files() has them */
    char shader_path[PATH_MAX];
    char *shader_files; /* as struct compilation has them; NULL: not compiled yet */
    bool shader_broken;
    struct inputs_state taken, seen; /* when they were read last; when they were last looked at */
    double last_look_ms, unchanged_since_ms, saved_ms;
};

/* The shader is whitted.comp in that folder, or where that is NULL, in the one that was installed with the
 * program or, for a program that is not installed, in the source tree. A file that is missing now is a
 * mistake on the command line, not one to be corrected in an editor: STATUS_REFUSED (reported). */
enum status inputs_create(const char *scene_path, const char *shader_folder, struct inputs *inputs);
void inputs_destroy(struct inputs *inputs);

/* Looks at the files. Whether they are others than those taken, and whole: nothing has changed for a moment,
 * nobody is writing as far as can be known, and whatever is written from now on will show. They count as
 * taken then, and *saved_ms is when they were saved, by clock_ms(). Call it every 20 ms or so. */
bool inputs_take(struct inputs *inputs, double *saved_ms);

/* The scene file's text, to be freed by the caller; NULL (reported) and errno where it cannot be read. */
char *inputs_read_scene(const struct inputs *inputs, size_t *length);

/* Whether the files with spheres that the scene names are those that are followed. If not, they are from now
 * on, and all files will be taken again when these are whole, too. *sphere_files was the caller's. */
bool inputs_follow_spheres(struct inputs *inputs, char **sphere_files);

/* Whether the files are still those taken: to be asked when they have been read. If not, what has been read
 * may be half a file, and they will be taken again. */
bool inputs_hold(const struct inputs *inputs);

/* The same after the shader has been compiled from these files, broken or not. They are followed from now on,
 * and were the caller's. */
bool inputs_follow(struct inputs *inputs, char **shader_files, bool broken);

#endif
