#include "watch/view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "check/compare.h"
#include "watch/camera_motion.h"

static const double wait_seconds = 0.02; /* between looks at the files */
static const double rest_ms = 200;       /* without motion, until the camera counts as at rest */
static const double frame_ms = 25;       /* what a picture may take while the camera moves */

static void set_title(const struct watch_view *view, const struct watching *watching)
{
    const struct picture *shown = watching->shown;
    const char *scene = watching->options->scene;
    const char *device = watching->live.context->properties.deviceName;
    char speed[64] = "";
    double rays = shown ? (double)atomic_load(&shown->rays) : 0;
    if (shown && rays > 0)
        snprintf(speed, sizeof speed, " - %.1f ms, %.1f million rays/s", shown->dispatch_ms,
                 rays / shown->dispatch_ms / 1e3);
    else if (shown)
        snprintf(speed, sizeof speed, " - %.1f ms", shown->dispatch_ms);
    if (view->shows_difference)
        watch_window_title(watching->window, "%s - %zu pixels differ from the reference", scene,
                           view->differing);
    else
        watch_window_title(watching->window, "%s - %s%s%s%s", scene, device, speed,
                           watching->failure[0] ? " - " : "", watching->failure);
}

static bool moves(const struct display_input *input)
{
    return input->orbit_x != 0 || input->orbit_y != 0 || input->pan_x != 0 || input->pan_y != 0 ||
           input->zoom != 0;
}

static void move_camera(struct watch_view *view, struct watching *watching, const struct display_input *input)
{
    struct scene_camera *camera = &watching->camera;
    camera_orbit(camera, input->orbit_x, input->orbit_y);
    camera_pan(camera, input->pan_x, input->pan_y);
    camera_zoom(camera, input->zoom);
    view->moving = true;
    view->shows_difference = false;
    view->last_motion_ms = clock_ms();
    double fine_ms = watching->shown ? watching->shown->dispatch_ms : 0;
    watch_preview(watching, (unsigned)fmin(fmax(ceil(sqrt(fine_ms / frame_ms)), 1), 16));
}

/* Beside the scene's name in the working folder, under a number that is free. */
static void save_picture(const struct watching *watching)
{
    const char *slash = strrchr(watching->options->scene, '/');
    const char *name = slash ? slash + 1 : watching->options->scene;
    char path[512];
    unsigned number = 1;
    do
        snprintf(path, sizeof path, "%.*s-%u.png", (int)fmin((double)strcspn(name, "."), 400), name,
                 number++);
    while (access(path, F_OK) == 0);
    if (job_write(&watching->shown->job, &watching->shown->image, (const char *const[]){path}, 1,
                  watching->options->transfer, watching->live.context->properties.deviceName) == STATUS_DONE)
        log_notice("picture %u: saved as %s", watching->shown->number, path);
}

static void toggle_difference(struct watch_view *view, struct watching *watching)
{
    const struct picture *shown = watching->shown;
    struct rendering reference;
    view->shows_difference = !view->shows_difference;
    if (!view->shows_difference)
        watch_window_show(watching->window, &shown->image, watching->options->transfer);
    if (!view->shows_difference || render_on_cpu(&shown->job.plan, &reference) != STATUS_DONE)
        return;
    struct comparison comparison;
    image_compare(&shown->image, &reference.image, NULL, &comparison);
    view->differing = comparison.differing;
    watch_window_show_difference(watching->window, &shown->image, &reference.image);
    image_destroy(&reference.image);
}

static void obey_keys(struct watch_view *view, struct watching *watching, const struct display_input *input)
{
    if (input->reset && watching->has_camera) {
        watching->camera = watching->file_camera;
        view->moving = true; /* and at rest, by now */
    }
    if (input->print_camera && watching->has_camera) {
        camera_print(stdout, &watching->camera);
        fflush(stdout);
    }
    if (input->save && watching->shown)
        save_picture(watching);
    if (input->difference && watching->shown)
        toggle_difference(view, watching);
}

enum status watch_view_follow(struct watch_view *view, struct watching *watching, bool *closed)
{
    struct display_input input;
    set_title(view, watching);
    enum status status = display_wait(watching->window->display, wait_seconds, &input);
    if (status != STATUS_DONE)
        return status;
    *closed = input.closed;
    if (moves(&input) && watching->has_camera)
        move_camera(view, watching, &input);
    else if (view->moving && clock_ms() - view->last_motion_ms > rest_ms) {
        view->moving = false;
        if (!watching->failure[0])
            watch_turn(watching, clock_ms());
    }
    obey_keys(view, watching, &input);
    return STATUS_DONE;
}
