#include "watch/watch.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "check/compare.h"
#include "check/heatmap.h"
#include "vulkan/probe.h"
#include "watch/camera_motion.h"

static const double wait_seconds = 0.02; /* between looks at the files */
static const double rest_ms = 200;       /* without motion, until the camera counts as at rest */
static const double frame_ms = 25;       /* what a picture may take while the camera moves */

static void set_title(const struct session *session)
{
    const struct picture *shown = session->shown;
    const char *device = session->context->properties.deviceName, *failure = session->failure;
    char title[1024], state[512];
    if (session->shows_difference)
        snprintf(state, sizeof state, "%zu pixels differ from the reference", session->differing);
    else if (shown)
        snprintf(state, sizeof state, "%s - %.1f ms", device, shown->dispatch_ms);
    else
        snprintf(state, sizeof state, "%s", device);
    snprintf(title, sizeof title, "%s - %s%s%s", session->options->scene, state, failure[0] ? " - " : "",
             failure);
    display_set_title(session->display, title);
}

static bool moves(const struct display_input *input)
{
    return input->orbit_x != 0 || input->orbit_y != 0 || input->pan_x != 0 || input->pan_y != 0 ||
           input->zoom != 0;
}

/* While the camera moves, the picture is as coarse as it must be to follow. */
static void move_camera(struct session *session, const struct display_input *input)
{
    camera_orbit(&session->camera, input->orbit_x, input->orbit_y);
    camera_pan(&session->camera, input->pan_x, input->pan_y);
    camera_zoom(&session->camera, input->zoom);
    session->moving = true;
    session->last_motion_ms = clock_ms();
    double coarseness = ceil(sqrt(session->shown->dispatch_ms / frame_ms));
    session_preview(session, (unsigned)fmin(fmax(coarseness, 1), 16));
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

/* Shows where the picture and the reference differ, or the picture again. */
static void toggle_difference(struct session *session)
{
    const struct image *image = &session->shown->image;
    struct rendering reference;
    if (session->shows_difference)
        session_show(session, image);
    else if (render_on_cpu(&session->shown->job.plan, &reference) == STATUS_DONE) {
        const struct comparison comparison = image_compare(image, &reference.image, NULL);
        session->shows_difference = true;
        session->differing = comparison.differing;
        unsigned char *rgb = display_picture(session->display, image->width, image->height);
        for (size_t i = 0; rgb && i < (size_t)image->width * image->height; ++i)
            heatmap_color(image->rgb + 3 * i, reference.image.rgb + 3 * i, rgb + 3 * i);
        image_destroy(&reference.image);
    }
}

static void obey(struct session *session, const struct display_input *input)
{
    if (moves(input)) {
        move_camera(session, input);
    } else if (session->moving && clock_ms() - session->last_motion_ms > rest_ms) {
        session->moving = false;
        if (!session->failure[0])
            session_render(session, clock_ms());
    }
    if (input->reset) {
        session->camera = session->file_camera;
        session->moving = true; /* and at rest, by now */
    }
    if (input->print_camera) {
        camera_print(stdout, &session->camera);
        fflush(stdout);
    }
    if (input->save)
        save_picture(session);
    if (input->difference)
        toggle_difference(session);
}

/* Takes input to the window, for which it waits so long, and does what it asks for. */
static enum status take_input(struct session *session, double seconds, bool *closed)
{
    struct display_input input = {0};
    set_title(session);
    enum status status = display_wait(session->display, seconds, &input);
    *closed = input.closed;
    if (status == STATUS_DONE && session->shown)
        obey(session, &input);
    return status;
}

static enum status follow(struct session *session)
{
    const struct watch_options *options = session->options;
    bool closed = false;
    double saved_ms;
    enum status status = STATUS_DONE;
    while (status == STATUS_DONE && !closed && session->context) {
        if (inputs_take(&session->inputs, &saved_ms))
            session_take(session, saved_ms);
        if (!session->context)
            break;
        if (options->window && !session->display && session->failure[0]) /* for the title */
            status = display_create(600, 400, &session->display);
        bool compares = session->shown && session->shown->band > 0 && !session->moving;
        if (compares)
            picture_compare(session->shown);
        double seconds = compares ? 0 : wait_seconds;
        if (status == STATUS_DONE && session->display)
            status = take_input(session, seconds, &closed);
        else
            nanosleep(&(struct timespec){.tv_nsec = (long)(seconds * 1e9)}, NULL);
    }
    return session->context ? status : STATUS_UNABLE;
}

enum status watch(const struct watch_options *options)
{
    struct session session = {.options = options};
    transfer_encoder_init(options->transfer, &session.encoder);
    enum status status = inputs_create(options->scene, options->shader_folder, &session.inputs);
    if (status == STATUS_DONE && options->window)
        status = display_connect();
    if (status == STATUS_DONE)
        status = vulkan_context_create(&options->vulkan, &session.context);
    if (status == STATUS_DONE && !options->job.plan.fast)
        status = probe_require_exact(session.context);
    if (status == STATUS_DONE)
        status = follow(&session);
    enum status closed = session_destroy(&session);
    if (options->window)
        display_disconnect();
    return status == STATUS_DONE ? closed : status;
}
