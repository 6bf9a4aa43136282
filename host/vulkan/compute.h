#ifndef VKWHITTED_VULKAN_COMPUTE_H
#define VKWHITTED_VULKAN_COMPUTE_H

#include "vulkan/pass.h"

/* A dispatch with an input (binding 0 of set 0) and an output (binding 1), both storage buffers. */
struct compute_job {
    struct spirv code;
    const struct pass_constant *constants;
    uint32_t constant_count;
    const void *input;
    size_t input_size; /* bytes */
    void *output;
    size_t output_size;
    uint32_t groups;
};

/* Runs the job once and waits for it. Failures are reported. */
enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job);

#endif
