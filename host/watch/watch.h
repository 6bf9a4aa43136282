#ifndef VKWHITTED_WATCH_WATCH_H
#define VKWHITTED_WATCH_WATCH_H

#include "tracer/job.h"

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

/* Keeps the picture current while the scene file and the shader change, until Ctrl-C or the window is closed.
 */
enum status watch(const struct watch_options *options);

#endif
