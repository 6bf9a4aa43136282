#ifndef VKWHITTED_JOB_H
#define VKWHITTED_JOB_H

#include "options.h"

/* A scene file made ready to render as the command line says. */
struct job {
    struct scene scene;
    struct packed_scene packed;
    struct render_plan plan;
    unsigned max_bounces;
};

/* Reads and packs the scene. On failure (reported) the job is empty; otherwise the caller frees it. */
enum status job_create(const struct options *options, const char *scene_path, struct job *job);

/* The same for a scene that has been read: the job takes it over, and *scene is empty then. */
enum status job_create_from(const struct options *options, struct scene *scene, struct job *job);
void job_destroy(struct job *job);

#endif
