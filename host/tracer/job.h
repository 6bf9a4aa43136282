#ifndef VKWHITTED_TRACER_JOB_H
#define VKWHITTED_TRACER_JOB_H

#include "image/tile.h"
#include "scene/pack.h"
#include "tracer/render.h"

/* What is asked of a picture beyond what its scene file says. */
struct job_options {
    unsigned width, height; /* 0: the scene's */
    int max_bounces;        /* -1: the scene's */
    unsigned samples;       /* a pixel */
    unsigned light_samples; /* 0: the scene's */
    bool has_max_error;
    double max_error;        /* linear radiance */
    struct tile tile;        /* but for what is dealt out; count 0: none */
    struct render_plan plan; /* but for its scene; window of width 0: the whole picture */
};

/* A scene file made ready to render. */
struct job {
    struct scene scene;
    struct packed_scene packed;
    struct render_plan plan;
    struct tile tile; /* of which the plan has the rows; count 0: the plan has the whole */
    double max_error; /* negative: rays are not left out */
};

/* Reads and packs the scene. On failure (reported) the job is empty; otherwise the caller frees it. */
enum status job_create(const struct job_options *options, const char *scene_path, struct job *job);

/* The same for a scene that has been read: the job takes it over, and *scene is empty then. other: another
 * job's packed scene, see pack_scene(); or NULL. */
enum status job_create_from(const struct job_options *options, const struct packed_scene *other,
                            struct scene *scene, struct job *job);
void job_destroy(struct job *job);

/* Writes the picture of the job, rendered on the device of that name, to each of the files, each whole or not
 * at all. */
enum status job_write(const struct job *job, const struct image *image, const char *const *paths,
                      size_t path_count, enum transfer transfer, const char *device);

#endif
