#ifndef VKWHITTED_VULKAN_PASS_H
#define VKWHITTED_VULKAN_PASS_H

#include "vulkan/context.h"

/* A compiled shader. */
struct spirv {
    const uint32_t *words;
    size_t size; /* bytes */
};

/* A specialization constant, 32 bits. */
struct pass_constant {
    uint32_t id, value;
};

/* What a binding of set 0 is: a whole buffer or a part of it, as a uniform or a storage buffer. */
struct pass_binding {
    VkDescriptorType type;
    VkDescriptorBufferInfo memory;
};

enum { PASS_MOST_BINDINGS = 16, PASS_MOST_CONSTANTS = 32 };

struct pass_info {
    const char *name; /* for debuggers */
    struct spirv code;
    const struct pass_constant *constants; /* at most PASS_MOST_CONSTANTS */
    uint32_t constant_count;
    const struct pass_binding *bindings; /* 0, 1, 2...; at most PASS_MOST_BINDINGS */
    uint32_t binding_count;
    uint32_t push_constant_size; /* bytes, perhaps 0 */
};

/* A compute shader with its buffers, and the commands that run it. */
struct vulkan_pass {
    struct vulkan_context *context;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkPipeline pipeline;
    uint32_t push_constant_size;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkQueryPool timestamps; /* of the dispatch; VK_NULL_HANDLE: the queue has none */
};

/* What to run. */
struct pass_dispatch {
    const void *push_constants;
    uint32_t groups_x, groups_y;
    VkBuffer copy_from, copy_to; /* afterwards; VK_NULL_HANDLE: nothing is copied */
    VkDeviceSize copy_size;      /* bytes */
};

/* Builds the pass; nothing of info is needed afterwards but the buffers. On failure (reported) *pass is
 * empty. */
enum status vulkan_pass_create(struct vulkan_context *context, const struct pass_info *info,
                               struct vulkan_pass *pass);

/* Destroys a pass that the device no longer uses, or nothing, and empties *pass. */
void vulkan_pass_destroy(struct vulkan_pass *pass);

/* Runs the pass and waits for it. It sees what was written on the device before, and the host what it writes.
 * *device_ms is the time that the dispatch took by the device's timestamps, or, where there are none, since
 * the submission. Failures are reported. */
enum status vulkan_pass_run(struct vulkan_pass *pass, const struct pass_dispatch *dispatch,
                            double *device_ms);

/* A dispatch with an input (binding 0 of set 0) and an output (binding 1), both storage buffers. */
struct compute_job {
    struct pass_info pass; /* but for the bindings */
    const void *input;
    size_t input_size; /* bytes */
    void *output;
    size_t output_size;
    uint32_t groups;
};

/* Runs the job once and waits for it. Failures are reported. */
enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job);

#endif
