#ifndef VKWHITTED_VULKAN_PIPELINE_H
#define VKWHITTED_VULKAN_PIPELINE_H

#include "vulkan/context.h"

/* A compiled shader. */
struct spirv {
    const uint32_t *words;
    size_t size; /* bytes */
};

/* Builds a compute pipeline from the code's main(), its specialization constants 0, 1, 2... being these. On
 * failure (reported) *pipeline is left alone. */
enum status vulkan_pipeline_create(struct vulkan_context *context, struct spirv code, VkPipelineLayout layout,
                                   const uint32_t *constants, uint32_t constant_count, VkPipeline *pipeline);

#endif
