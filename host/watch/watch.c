#include "watch/watch.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "check/compare.h"
#include "check/heatmap.h"
#include "vulkan/probe.h"
#include "watch/camera_motion.h"

static const double wait_seconds = 0.02; /* between looks at the files */
static const double rest_ms = 200;       /* without motion, until the camera counts as at rest */
static const double frame_ms = 25;       /* what a picture may take while the camera moves */

/* What the window shows beyond the session's picture. */
struct view {
    bool moving;
    double last_motion_ms;
    bool shows_difference;
    size_t differing; /* pixels, while it does */
};

static void set_title(const struct view *view, const struct session *session)
{
    const struct picture *shown = session->shown;
    char title[1024], speed[64] = "";
    double rays = shown ? (double)atomic_load(&shown->rays) : 0;
    if (shown && rays > 0)
        snprintf(speed, sizeof speed, " - %.1f ms, %.1f million rays/s", shown->dispatch_ms,
                 rays / shown->dispatch_ms / 1e3);
    else if (shown)
        snprintf(speed, sizeof speed, " - %.1f ms", shown->dispatch_ms);
    if (view->shows_difference)
        snprintf(title, sizeof title, "%s - %zu pixels differ from the reference", session->options->scene,
                 view->differing);
    else
        snprintf(title, sizeof title, "%s - %s%s%s%s", session->options->scene,
                 session->context->properties.deviceName, speed, session->failure[0] ? " - " : "",
                 session->failure);
    display_set_title(session->display, title);
}

static bool moves(const struct display_input *input)
{
    return input->orbit_x != 0 || input->orbit_y != 0 || input->pan_x != 0 || input->pan_y != 0 ||
           input->zoom != 0;
}

/* While the camera moves, the picture is as coarse as it must be to follow. */
static void move_camera(struct view *view, struct session *session, const struct display_input *input)
{
    camera_orbit(&session->camera, input->orbit_x, input->orbit_y);
    camera_pan(&session->camera, input->pan_x, input->pan_y);
    camera_zoom(&session->camera, input->zoom);
    *view = (struct view){.moving = true, .last_motion_ms = clock_ms()};
    double fine_ms = session->shown ? session->shown->dispatch_ms : 0;
    session_preview(session, (unsigned)fmin(fmax(ceil(sqrt(fine_ms / frame_ms)), 1), 16));
}

/* Under the scene's name in the working folder, with a number that is free. */
static void save_picture(const struct session *session)
{
    const struct picture *shown = session->shown;
    const char *slash = strrchr(session->options->scene, '/');
    const char *name = slash ? slash + 1 : session->options->scene;
    char path[512];
    unsigned number = 1;
    do
        snprintf(path, sizeof path, "%.*s-%u.png", (int)fmin((double)strcspn(name, "."), 400), name,
                 number++);
    while (access(path, F_OK) == 0);
    if (job_write(&shown->job, &shown->image, (const char *const[]){path}, 1, session->options->transfer,
                  session->context->properties.deviceName) == STATUS_DONE)
        log_notice("picture %u: saved as %s", shown->number, path);
}

/* Shows where the picture and the reference differ, in the colours of heatmap_write(), or the picture again.
 */
static void toggle_difference(struct view *view, struct session *session)
{
    const struct image *image = &session->shown->image;
    struct rendering reference;
    struct comparison comparison;
    view->shows_difference = !view->shows_difference;
    if (!view->shows_difference)
        session_show(session, image);
    if (!view->shows_difference || render_on_cpu(&session->shown->job.plan, &reference) != STATUS_DONE)
        return;
    image_compare(image, &reference.image, NULL, &comparison);
    view->differing = comparison.differing;
    unsigned char *rgba = display_picture(session->display, image->width, image->height);
    for (size_t i = 0; rgba && i < (size_t)image->width * image->height; ++i)
        heatmap_color(image->rgb + 3 * i, reference.image.rgb + 3 * i, rgba + 4 * i);
    image_destroy(&reference.image);
}

static void obey_keys(struct view *view, struct session *session, const struct display_input *input)
{
    if (input->reset && session->has_camera) {
        session->camera = session->file_camera;
        view->moving = true; /* and at rest, by now */
    }
    if (input->print_camera && session->has_camera) {
        camera_print(stdout, &session->camera);
        fflush(stdout);
    }
    if (input->save && session->shown)
        save_picture(session);
    if (input->difference && session->shown)
        toggle_difference(view, session);
}

/* Waits for a moment, for input to the window if there is one, and does what it asks for. */
static enum status wait(struct view *view, struct session *session, bool *closed)
{
    struct display_input input;
    if (!session->display) {
        nanosleep(&(struct timespec){.tv_nsec = (long)(wait_seconds * 1e9)}, NULL);
        return STATUS_DONE;
    }
    set_title(view, session);
    enum status status = display_wait(session->display, wait_seconds, &input);
    if (status != STATUS_DONE)
        return status;
    *closed = input.closed;
    if (moves(&input) && session->has_camera) {
        move_camera(view, session, &input);
    } else if (view->moving && clock_ms() - view->last_motion_ms > rest_ms) {
        view->moving = false;
        if (!session->failure[0])
            session_render(session, clock_ms());
    }
    obey_keys(view, session, &input);
    return STATUS_DONE;
}

static enum status follow(struct session *session)
{
    struct view view = {0};
    bool closed = false;
    double saved_ms;
    enum status status = STATUS_DONE;
    while (status == STATUS_DONE && !closed && !interrupt_requested()) {
        if (inputs_take(&session->inputs, &saved_ms)) {
            view.shows_difference = false;
            session_take(session, saved_ms);
            if (session->options->window && !session->display && session->failure[0]) /* for the title */
                status = display_create(session->context, 600, 400, &session->display);
        }
        if (status == STATUS_DONE)
            status = wait(&view, session, &closed);
    }
    return status;
}

static enum status open_device(struct session *session)
{
    struct vulkan_options vulkan = session->options->vulkan;
    enum status status = session->options->window ? display_connect(&vulkan) : STATUS_DONE;
    if (status == STATUS_DONE)
        status = vulkan_context_create(&vulkan, &session->context);
    if (status == STATUS_DONE && !session->options->job.fast)
        status = probe_require_exact(session->context);
    return status;
}

enum status watch(const struct watch_options *options)
{
    struct session session = {.options = options};
    srgb_encoder_init(&session.encoder);
    enum status status = inputs_create(options->scene, options->shader_folder, &session.inputs);
    if (status == STATUS_DONE)
        status = open_device(&session);
    if (status == STATUS_DONE && (options->check || options->window))
        status = background_check_create(options->check, &session.check);
    if (status == STATUS_DONE)
        status = follow(&session);
    enum status closed = session_destroy(&session);
    if (options->window)
        display_disconnect();
    return status == STATUS_DONE ? closed : status;
}
