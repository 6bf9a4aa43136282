#ifndef VKWHITTED_PIXEL_TRACE_H
#define VKWHITTED_PIXEL_TRACE_H

#include "base/json.h"
#include "pixel/ray_tree.h"
#include "scene/body.h"
#include "tracer/job.h"

/* A step of the ray tree, as each side tells it; NULL where that side has no such step. */
struct step {
    const struct reference_event *device, *reference, *exact;
};

/* All that is known of a pixel: the first of the job's window. */
struct pixel_trace {
    const struct job *job;
    const struct vulkan_context *context;
    enum precision against;                   /* PRECISION_FLOAT where there is no analysis */
    double scale;                             /* scene units in a metre */
    struct ray_tree device, reference, exact; /* exact: the analysis */
    struct step
        *steps; /* the device's in their order, then the reference's, empty where the device has them */
    size_t step_count;
    double picture[3];    /* the pixel as the device renders it without recording */
    bool is_the_pictures; /* what was recorded ends in the same bits as that */
    struct event_difference difference;
};

/* Traces the pixel on the device, with the reference and, unless against is PRECISION_FLOAT, at that
 * precision with error bounds. The job and the context must outlive the trace, which the caller frees with
 * pixel_trace_destroy(); it is empty on failure (reported). */
enum status pixel_trace_create(struct vulkan_context *context, const struct job *job, enum precision against,
                               struct pixel_trace *trace);
void pixel_trace_destroy(struct pixel_trace *trace);

enum { SURFACE_NAME = BODY_NAME };

/* The name of an object by the number of its surface; "nothing" below 0. Of a sphere from a file, which is
 * written to text: "Flake" row 17, where rows count from 0. */
const char *surface_name(const struct pixel_trace *trace, double surface, char text[static SURFACE_NAME]);

enum { BITS_TEXT = 20 };

/* The bits of one side's value where the sides first differ, in the picture's precision and hexadecimal:
 * text, or NULL where they differ in something else. */
const char *difference_bits(const struct pixel_trace *trace, const struct ray_tree *side,
                            char text[static BITS_TEXT]);

/* Prints the ray tree. all_light_samples: otherwise those of a light are summed up. */
void pixel_print(const struct pixel_trace *trace, bool all_light_samples);

/* Prints in a line whether device and reference agree. */
void pixel_print_verdict(const struct pixel_trace *trace);

/* As a JSON object; NULL without memory. */
json_t *pixel_json(const struct pixel_trace *trace);

#endif
