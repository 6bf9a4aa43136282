#ifndef VKWHITTED_BENCH_SCENE_H
#define VKWHITTED_BENCH_SCENE_H

#include <jansson.h>

#include "tracer/render.h"

struct bench_options {
    unsigned width, height; /* 0: the scene's */
    bool quick, quiet;
    bool wants_pictures; /* for the report */
};

/* Measures one scene as the options say, on the context's device, or with NULL on the CPU alone. *document
 * gets what document.h says of it, with "pictures" (see report.h) where they are wanted; NULL with any status
 * but STATUS_DONE. A setting that the device cannot do is left out with a warning. */
enum status bench_scene(const struct bench_options *options, struct vulkan_context *context, const char *path,
                        json_t **document);

#endif
