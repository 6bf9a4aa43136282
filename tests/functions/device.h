#ifndef DEVICE_H
#define DEVICE_H

#include <stdbool.h>
#include <stddef.h>

#include "function_table.h"
#include "vulkan/buffer.h"
#include "vulkan/pass.h"

enum { BATCH = 1 << 16 }; /* cases a dispatch */

/* Runs functions.comp, of which the build has made one module a function. The host writes a batch's inputs
 * and reads its outputs in place. */
struct device {
    struct vulkan_context *context;
    bool corrected;             /* the root, and division if that is */
    bool corrected_division;
    struct vulkan_buffer scene; /* functions.comp has the scene's bindings, and never reads them */
    struct vulkan_buffer inputs, outputs;
    struct vulkan_pass pass; /* of the function that is loaded */
    struct pass_frame frame;
};

/* Prepares everything but the pass. Division and root are corrected where the device needs it, as the
 * renderer does, or in any case; on failure the reason is reported and *device is destroyed. */
enum status device_create(struct vulkan_context *context, bool corrected, struct device *device);
void device_destroy(struct device *device);

/* Builds the pass that calls the test's function, in place of the one before. */
enum status device_load(struct device *device, const struct function_test *test);

/* Runs the pass on `count` cases, at most BATCH; *ns is the time the device took, or that the host waited
 * where the device has no timestamps. */
enum status device_run(struct device *device, size_t count, double *ns);

#endif
