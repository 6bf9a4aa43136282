#ifndef VKWHITTED_WATCH_INPUTS_H
#define VKWHITTED_WATCH_INPUTS_H

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* What a picture is made of: the scene, the files with spheres that it names, and what the shader was
 * compiled from last; as long as that does not compile also what else of *.comp, *.glsl and *.h lies in its
 * folder, for that may be what mends it. */
enum input_kind { INPUT_SCENE, INPUT_SPHERES, INPUT_SHADER, INPUT_KINDS };

/* The state of the files of each kind, as stat() tells it, in a number: another one, other files. */
struct inputs_state {
    uint64_t of[INPUT_KINDS];
};

struct inputs {
    const char *scene_path; /* the caller's */
    char shader_path[PATH_MAX];
    char *files[INPUT_KINDS]; /* followed beside these: paths, each with a 0, and another 0; or NULL */
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

/* Whether the files are still those taken: to be asked when they have been read. If not, what has been read
 * may be half a file, and they will be taken again. */
bool inputs_hold(const struct inputs *inputs);

/* To be asked when inputs_hold(), of spheres before they are read, of the shader when it has been compiled
 * and shader_broken is set. Follows these files (a list as above, which was the caller's) in the place of
 * others of their kind, and tells whether they are whole, and older than what was taken. If not, all will be
 * taken again.
 */
bool inputs_follow(struct inputs *inputs, enum input_kind kind, char **files);

#endif
