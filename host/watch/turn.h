#ifndef VKWHITTED_WATCH_TURN_H
#define VKWHITTED_WATCH_TURN_H

#include "watch/background_check.h"
#include "watch/inputs.h"
#include "watch/live_shader.h"
#include "watch/watch.h"
#include "watch/window.h"

/* What `watch` holds between the turns, each of which leads from changed files to a new picture or to the
 * reason why there is none. */
struct watching {
    const struct watch_options *options;
    struct watch_inputs inputs;
    struct live_shader live;
    bool shader_changed;            /* since it was compiled */
    struct background_check *check; /* NULL: nothing is compared or counted */
    struct watch_window *window;    /* NULL: none */
    struct picture *wanted;         /* the scene as the file says it now; NULL: it is refused */
    struct picture *shown;          /* the last good picture; NULL: none yet */
    char failure[256];              /* why the picture is not what the files say; empty: it is */
    bool has_camera;
    struct scene_camera file_camera, camera; /* the camera counts until the file says another one */
};

/* Makes a new picture and says on standard error what has become of it. */
enum status watch_turn(struct watching *watching, double saved_ms);

/* Shows the picture from the camera as it is now, every so many pixels; only while the files are good. */
enum status watch_preview(struct watching *watching, unsigned reduction);

#endif
