#ifndef VKWHITTED_WATCH_INPUTS_H
#define VKWHITTED_WATCH_INPUTS_H

#include "watch/file_watch.h"
#include "watch/shader_source.h"

/* The files that a picture is made of, as they were when last read. */
struct watch_inputs {
    const char *scene_path, *shader_path;
    char *scene; /* the scene file's text; NULL: it cannot be read */
    size_t scene_length;
    int scene_error; /* errno then */
    struct shader_source shader;
    struct file_watch *files;
    double last_look_ms;
};

enum status watch_inputs_create(const char *scene_path, const char *shader_path, struct watch_inputs *inputs);
void watch_inputs_destroy(struct watch_inputs *inputs);

struct watch_changes {
    bool scene, shader;
    double saved_ms; /* when, by clock_ms() */
};

/* Reads the files again if something has happened to them, once their writing has come to an end, or if they
 * have not been looked at for a second: inotify does not tell everything. Says which have another content
 * than before. */
enum status watch_inputs_read(struct watch_inputs *inputs, bool happened, struct watch_changes *changes);

#endif
