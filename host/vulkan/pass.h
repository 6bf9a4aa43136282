#ifndef VKWHITTED_VULKAN_PASS_H
#define VKWHITTED_VULKAN_PASS_H

#include "vulkan/float_controls.h"

/* A specialization constant, 32 bits. */
struct pass_constant {
    uint32_t id, value;
};

enum { PASS_MOST_BINDINGS = 16, PASS_MOST_CONSTANTS = 40 };

struct pass_info {
    const char *name;                      /* for debuggers */
    struct spirv code;                     /* 1.4 or later */
    bool fast;                             /* the device need not be told of its arithmetic */
    const struct pass_constant *constants; /* at most PASS_MOST_CONSTANTS */
    uint32_t constant_count;
    const VkDescriptorType *bindings; /* of set 0: buffers or texel buffers; at most PASS_MOST_BINDINGS */
    uint32_t binding_count;
    uint32_t push_constant_size; /* bytes, perhaps 0 */
};

/* A compute shader. */
struct vulkan_pass {
    struct vulkan_context *context;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorType bindings[PASS_MOST_BINDINGS];
    uint32_t binding_count, push_constant_size;
};

/* The buffers of a pass, and the commands that run it once. Each frame can be under way on the device. */
struct pass_frame {
    const struct vulkan_pass *pass; /* NULL: there is no frame */
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkQueryPool timestamps; /* of the dispatch; VK_NULL_HANDLE: the queue has none */
    double submitted_ms;    /* by the clock */
};

/* What to run. */
struct pass_dispatch {
    const void *push_constants;
    uint32_t groups_x, groups_y; /* 0: nothing but the copy */
    VkBuffer copy_from, copy_to; /* afterwards; VK_NULL_HANDLE: nothing is copied */
    VkDeviceSize copy_size;      /* bytes */
};

/* Builds the pass; nothing of info is needed afterwards. On failure (reported) *pass is empty. */
enum status vulkan_pass_create(struct vulkan_context *context, const struct pass_info *info,
                               struct vulkan_pass *pass);

/* Destroys a pass without frames, or nothing, and empties *pass. */
void vulkan_pass_destroy(struct vulkan_pass *pass);

/* Makes a frame with these buffers, and views of texel buffers (perhaps NULL), one for each binding that the
 * shader uses, which must outlive it, as the pass must. On failure (reported) *frame is empty. */
enum status pass_frame_create(const struct vulkan_pass *pass, const VkDescriptorBufferInfo *buffers,
                              const VkBufferView *texels, struct pass_frame *frame);

/* Destroys a frame that is not under way, or nothing, and empties *frame. */
void pass_frame_destroy(struct pass_frame *frame);

/* Starts the frame. It sees what was written on the device before, and the host what it writes. Failures are
 * reported. */
enum status pass_frame_submit(struct pass_frame *frame, const struct pass_dispatch *dispatch);

/* Waits for the frame. *device_ms, perhaps NULL, is the time that the dispatch took by the device's
 * timestamps, or, where there are none, since the submission. Failures are reported. */
enum status pass_frame_wait(struct pass_frame *frame, double *device_ms);

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
