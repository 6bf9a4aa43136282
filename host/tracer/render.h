#ifndef VKWHITTED_TRACER_RENDER_H
#define VKWHITTED_TRACER_RENDER_H

#include "base/progress.h"
#include "image/image.h"
#include "packed_scene.h"
#include "reference.h"
#include "tracer/tracer.h"

enum backend { BACKEND_VULKAN, BACKEND_CPU };
enum precision { PRECISION_FLOAT, PRECISION_DOUBLE, PRECISION_QUAD };

const char *precision_name(enum precision precision);

/* What to render and how. */
struct render_plan {
    const struct packed_scene *scene;
    struct window window;
    struct strips strips;          /* the window's rows; render_on_...() and spot_check() alone know them */
    enum precision precision;      /* quad only on the CPU */
    unsigned threads;              /* of the CPU; 0: one a processor */
    bool fast;                     /* on a device */
    struct shader_folder *shaders; /* of the device; NULL: the build's */
    unsigned repeat;               /* warm renderings after the first */
    bool count_rays;
    bool bound_truncation; /* fill the image's truncation */
    bool quiet;
};

struct rendering {
    struct image image; /* the window */
    double setup_ms;    /* pipeline and upload; on the CPU the tree of many spheres, or 0 */
    double first_dispatch_ms;
    struct tracer_times times;  /* medians of the warm renderings, or of the first if there are none */
    struct reference_rays rays; /* all 0 unless counted */
};

/* On STATUS_DONE the caller frees rendering->image; otherwise there is none and the reason is reported. */
enum status render_on_device(struct vulkan_context *context, const struct render_plan *plan,
                             struct rendering *rendering);
enum status render_on_cpu(const struct render_plan *plan, struct rendering *rendering);

/* Adds the rays that the device traces for one picture. */
enum status rays_on_device(struct vulkan_context *context, const struct render_plan *plan,
                           struct reference_rays *rays);

/* The path signatures of the window's pixels in float: the hash of every decision of the ray tree. The caller
 * frees them; NULL with any status but STATUS_DONE. */
enum status signatures_on_device(struct vulkan_context *context, const struct render_plan *plan,
                                 uint32_t **signatures);
enum status signatures_on_cpu(const struct render_plan *plan, uint32_t **signatures);

/* The exact picture with the error analysis of the float one (precision: double or quad), to be freed by the
 * caller. */
enum status explain_on_cpu(const struct render_plan *plan, enum precision precision,
                           struct reference_explanation **explanations);

/* What the two backends share. A function of theirs that renders the plan's window once into the image. */
typedef enum status render_once(void *renderer, const struct render_plan *plan, struct image *image,
                                struct progress *progress, struct tracer_times *times);

render_once render_once_on_device; /* whose renderer is a tracer */

/* Renders once cold and plan->repeat times warm, and fills rendering's image and times. On failure there is
 * no image. */
enum status render_repeatedly(render_once *render, void *renderer, const struct render_plan *plan,
                              struct rendering *rendering);

/* Room for a value of so many bytes a pixel, all 0; NULL (reported) without memory. */
void *allocate_pixels(const struct window *window, size_t size);

#endif
