#ifndef VKWHITTED_TRACER_VALUES_H
#define VKWHITTED_TRACER_VALUES_H

#include "image/image.h"
#include "reference.h"

/* Where a window's values go: the one that the tracer's output calls for; the others are NULL. */
struct tracer_values {
    struct image *image; /* of the window's size; gets the values in double precision and the charges, if it
                          * has room */
    struct reference_rays *rays; /* OUTPUT_RAYS: the window's are added */
    uint32_t *signatures;        /* OUTPUT_SIGNATURE: a pixel each */
};

/* How long a picture took, in milliseconds: from the first submission to the last completion, and on the
 * device by its own timestamps (where it has none, as the first). */
struct tracer_times {
    double dispatch_ms, device_ms;
};

#endif
