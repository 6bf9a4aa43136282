#ifndef VKWHITTED_VULKAN_BUFFER_H
#define VKWHITTED_VULKAN_BUFFER_H

#include "vulkan/context.h"

enum buffer_memory {
    BUFFER_DEVICE,   /* the device's own; mapped only where the host reads it as fast as its own */
    BUFFER_UPLOAD,   /* the host writes, the device reads */
    BUFFER_READBACK, /* the device writes, the host reads */
};

/* A buffer with memory of its own. */
struct vulkan_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *mapped; /* for the host, without flushes; NULL: the host does not see it */
};

/* Makes a buffer of any usage, its bytes undefined. On failure (reported) *buffer is empty. The name is for
 * debuggers. */
enum status vulkan_buffer_create(struct vulkan_context *context, const char *name, VkDeviceSize size,
                                 enum buffer_memory memory, struct vulkan_buffer *buffer);

/* Part of a buffer as texels of the format. On failure (reported) *view is VK_NULL_HANDLE. */
enum status vulkan_texels_create(struct vulkan_context *context, VkDescriptorBufferInfo part, VkFormat format,
                                 VkBufferView *view);
void vulkan_texels_destroy(struct vulkan_context *context, VkBufferView *view);

/* Destroys a buffer that the device no longer uses, or nothing, and empties *buffer. */
void vulkan_buffer_destroy(struct vulkan_context *context, struct vulkan_buffer *buffer);

#endif
