#ifndef VKWHITTED_TRACER_VALUES_H
#define VKWHITTED_TRACER_VALUES_H

#include "image/image.h"
#include "reference.h"

/* Where a window's values go; NULL: nowhere. With tracer_options.counts that is the last two. */
struct tracer_values {
    struct image *image; /* of the window's size; gets the values in double precision and the charges, if it
                          * has room */
    struct reference_rays *rays; /* the window's are added */
    uint32_t *signatures;        /* a pixel each */
};

/* How long a picture took, in milliseconds: from the first submission to the last completion, and on the
 * device by its own timestamps (where it has none, as the first). */
struct tracer_times {
    double dispatch_ms, device_ms;
};

#endif
