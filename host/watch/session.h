#ifndef VKWHITTED_WATCH_SESSION_H
#define VKWHITTED_WATCH_SESSION_H

#include "image/transfer.h"
#include "tracer/shader_folder.h"
#include "watch/display.h"
#include "watch/inputs.h"
#include "watch/picture.h"

struct watch_options {
    const char *scene;          /* path */
    const char *shader_folder;  /* NULL: the one that came with the program */
    const char *const *outputs; /* files that each picture is written to */
    size_t output_count;
    enum transfer transfer;
    struct vulkan_options vulkan;
    struct job_options job;
    bool check;  /* compare each picture with the reference */
    bool window; /* show pictures in one */
};

/* What `watch` holds from one picture to the next. */
struct session {
    const struct watch_options *options;
    struct inputs inputs;
    struct vulkan_context *context; /* NULL: it was lost and cannot be opened again */

    char *scene_text; /* as taken from the file; NULL: it cannot be read */
    size_t scene_length;
    uint64_t spheres_state;                  /* of the files with spheres then (see struct inputs_state) */
    bool scene_changed;                      /* and has not been warned of */
    struct scene_camera file_camera, camera; /* the camera counts until the file says another one */
    bool moving;                             /* the camera, so that the window shows a preview */
    double last_motion_ms;

    enum status compiled;    /* what came of compiling the shader */
    uint64_t compiled_state; /* of its files then (see struct inputs_state); 0: not compiled yet */
    struct shader_choice choice;
    char *messages;
    uint32_t *code; /* of the shader that compiled last, which the tracer uses */
    size_t code_size;
    struct tracer *tracer; /* NULL: to be built */

    struct picture *shown;   /* the last good picture; NULL: none yet */
    struct picture *traced;  /* whose scene the tracer holds; may be the same */
    char failure[256];       /* why the shown one is not what the files say; empty: it is */
    struct display *display; /* NULL: none, or not open yet */
    bool shows_difference;   /* between it and the reference, in the window */
    size_t differing;        /* pixels, while it does */
    struct transfer_encoder encoder;
};

/* Makes a picture of the files when they have been taken (see inputs_take()), and says on standard error what
 * has become of it. */
void session_take(struct session *session, double saved_ms);

/* The same with the files taken before, for another camera. */
void session_render(struct session *session, double saved_ms);

/* Shows the picture from the camera as it is now, every so many pixels; only while the files are good. There
 * is a picture already. */
void session_preview(struct session *session, unsigned reduction);

/* Shows it in the window, which is opened if there is none yet. */
enum status session_show(struct session *session, const struct image *image);

/* Destroys all but the options. Returns what vulkan_context_destroy() does. */
enum status session_destroy(struct session *session);

#endif
