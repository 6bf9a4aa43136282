#ifndef VKWHITTED_VULKAN_BUFFER_H
#define VKWHITTED_VULKAN_BUFFER_H

#include "vulkan/context.h"

/* A buffer with memory of its own, mapped if the host can see it. */
struct vulkan_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkMemoryPropertyFlags properties;
    void *mapped; /* NULL: only the device sees it */
};

/* Memory of the first property set that the device has; sets end with 0, which any memory satisfies. */
enum status vulkan_buffer_create(struct vulkan_context *context, VkDeviceSize size, VkBufferUsageFlags usage,
                                 const VkMemoryPropertyFlags *property_sets, struct vulkan_buffer *buffer);
void vulkan_buffer_destroy(struct vulkan_context *context, struct vulkan_buffer *buffer);

#endif
