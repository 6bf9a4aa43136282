#ifndef VKWHITTED_VULKAN_PASS_H
#define VKWHITTED_VULKAN_PASS_H

#include "vulkan/command.h"

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

/* A compute shader with its buffers: descriptor set, pipeline layout and pipeline. */
struct vulkan_pass {
    struct vulkan_context *context;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkPipeline pipeline;
    uint32_t push_constant_size;
};

/* Builds the pass; nothing of info is needed afterwards but the buffers. On failure (reported) *pass is
 * empty. */
enum status vulkan_pass_create(struct vulkan_context *context, const struct pass_info *info,
                               struct vulkan_pass *pass);

/* Destroys a pass that the device no longer uses, or nothing, and empties *pass. */
void vulkan_pass_destroy(struct vulkan_pass *pass);

/* Records the command's only dispatch, of so many work groups, with these push constants. */
void vulkan_pass_record(const struct vulkan_pass *pass, const struct vulkan_command *command,
                        const void *push_constants, uint32_t groups_x, uint32_t groups_y);

#endif
