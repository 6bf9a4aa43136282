#include "check/float_limit.h"

#include <math.h>
#include <stdio.h>

#include "reference.h"
#include "scene/body.h"
#include "scene/pack.h"
#include "tracer/reference_scene.h"

enum {
    SIDE = 16, /* pixels looked at are SIDE times SIDE */
    LEAST_OFF = SIDE * SIDE / 20,
    MOST_BOUNCES = 3, /* these and light samples are few, so that it takes a millisecond */
    MOST_LIGHT_SAMPLES = 4
};

/* A camera so many times as far from the origin of coordinates as from what it sees. */
static const double far_camera = 16;

/* Ordinary scenes have a few pixels, on edges and in glass, that float takes another way: up to 0.7 %, 2.8 %
 * in a mirrored cloud of spheres of four decades. Where float does not resolve what is seen, it is most. */
static const double off_by = 1e-2, darkest = 1e-3;

/* A pixel that is off: what it shows, and how far away, in scene units. */
struct off_pixel {
    int surface; /* -1: nothing */
    double distance;
};

/* Whether the pixel is off; what it shows. */
static bool is_off(const struct packed_scene *scene, int x, int y, struct off_pixel *shown)
{
    struct reference_event events[2]; /* the primary ray and its hit */
    struct reference_log log = {.events = events, .room = 2};
    const struct reference_pixel in_float = reference_trace_float(scene, x, y, NULL),
                                 exact = reference_trace_double(scene, x, y, &log);
    bool off = false;
    for (int c = 0; c < 3; ++c)
        off |= !(fabs(in_float.rgb[c] - exact.rgb[c]) < off_by * fmax(fabs(exact.rgb[c]), darkest));
    const bool hits = log.count >= 2 && events[1].head.place.EVENT_KIND == EVENT_HIT;
    *shown = (struct off_pixel){.surface = hits ? events[1].head.facts.EVENT_SURFACE : -1,
                                .distance = hits ? events[1].values[6] : 0};
    return off;
}

/* The number of pixels that are off, among those looked at. */
static size_t find_off_pixels(const struct packed_scene *scene, struct off_pixel off[SIDE * SIDE])
{
    size_t count = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const int x = (int)((2 * (i % SIDE) + 1) * (int64_t)scene->width / (2 * SIDE));
        const int y = (int)((2 * (i / SIDE) + 1) * (int64_t)scene->height / (2 * SIDE));
        count += is_off(scene, x, y, &off[count]);
    }
    return count;
}

/* One that shows what most show. */
static struct off_pixel most_frequent(const struct off_pixel *off, size_t count)
{
    struct off_pixel found = {.surface = -1};
    size_t most = 0;
    for (size_t i = 0; i < count; ++i) {
        size_t same = 0;
        for (size_t k = i; k < count; ++k)
            same += off[k].surface == off[i].surface;
        if (off[i].surface >= 0 && same > most) {
            most = same;
            found = off[i];
        }
    }
    return found;
}

static void warn(const struct job *job, struct off_pixel off, double share)
{
    static const char *const types[] = {
        [OBJECT_SPHERE] = "sphere", [OBJECT_PLANE] = "plane", [OBJECT_SPHERES] = "spheres"};
    const struct scene *scene = &job->scene;
    const double distance = off.distance / pack_scale(scene),
                 coordinates = dvec3_largest(dvec3_of(scene->camera.position));
    const bool far_out = coordinates > far_camera * distance;
    char name[BODY_NAME], size[32] = "", why[96];
    const size_t number = (size_t)body_file_order(&job->packed, off.surface);
    const struct body_place place = body_find(scene, number);
    const struct scene_object *object = place.object;
    const struct body body = body_numbered(scene, number);
    if (body.is_ball)
        snprintf(size, sizeof size, "radius %.3g m, ", body.number);
    snprintf(why, sizeof why, far_out ? "seen from %.3g m, at coordinates of %.3g m" : "seen from %.3g m",
             distance, coordinates);
    log_warning("%s:%d:%d: %s %s: %s%s: shading is off by 1 %% or more in %.0f %% of the pixels "
                "looked at; %suse --precision double",
                scene->path, object->place.line, object->place.column, types[object->type],
                body_name(place, name), size, why, 100 * share,
                far_out ? "move the scene to the origin of coordinates, or " : "");
}

enum status float_limit_warn(const struct job *job)
{
    const struct render_plan *plan = &job->plan;
    struct packed_scene scene;
    struct off_pixel off[SIDE * SIDE];
    if (plan->precision != PRECISION_FLOAT)
        return STATUS_DONE;
    enum status status = reference_scene(plan->scene, plan->threads, &scene);
    if (status != STATUS_DONE)
        return status;
    scene.samples = 1;
    scene.view.truncation.ALLOWANCE = -1; /* no ray is left out */
    scene.max_bounces = scene.max_bounces < MOST_BOUNCES ? scene.max_bounces : MOST_BOUNCES;
    scene.light_samples = scene.light_samples < MOST_LIGHT_SAMPLES ? scene.light_samples : MOST_LIGHT_SAMPLES;
    const size_t count = find_off_pixels(&scene, off);
    const struct off_pixel found = most_frequent(off, count);
    if (count > LEAST_OFF && found.surface >= 0)
        warn(job, found, (double)count / (SIDE * SIDE));
    return STATUS_DONE;
}
