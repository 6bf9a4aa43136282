#ifndef VKWHITTED_PIXEL_PIXEL_H
#define VKWHITTED_PIXEL_PIXEL_H

#include "tracer/job.h"

struct pixel_options {
    const char *scene; /* path */
    unsigned x, y;     /* pixels from the top left */
    struct vulkan_options vulkan;
    struct job_options job;
    enum precision against; /* PRECISION_FLOAT: without error analysis */
    bool all_light_samples; /* otherwise those of a light are summed up */
    const char *json;       /* path of the file to write, or NULL */
};

/* Prints the ray tree of one pixel, as the device and the reference compute it (not if job.quiet), and
 * whether they agree. STATUS_DIFFERS where they do not, or where the picture's pipeline makes another pixel
 * than the recording one; STATUS_REFUSED (reported) for a pixel outside the picture. */
enum status pixel_show(const struct pixel_options *options);

#endif
