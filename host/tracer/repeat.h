#ifndef VKWHITTED_TRACER_REPEAT_H
#define VKWHITTED_TRACER_REPEAT_H

#include "base/progress.h"
#include "tracer/render.h"

/* Renders the plan's window once into the image. */
typedef enum status render_once(void *renderer, const struct render_plan *plan, struct image *image,
                                struct progress *progress, double *milliseconds);

/* Renders once cold and plan->repeat times warm, and fills rendering's image and times. On failure there is
 * no image. */
enum status render_repeatedly(render_once *render, void *renderer, const struct render_plan *plan,
                              struct rendering *rendering);

/* Room for a value of so many bytes a pixel, all 0; NULL (reported) without memory. */
void *allocate_pixels(const struct window *window, size_t size);

#endif
