#include "vulkan/buffer.h"

#include <inttypes.h>

/* The first memory type of those allowed that has the properties, or UINT32_MAX. */
static uint32_t find_memory_type(const struct vulkan_context *context, uint32_t allowed,
                                 VkMemoryPropertyFlags properties)
{
    for (uint32_t i = 0; i < context->memory.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (context->memory.memoryTypes[i].propertyFlags & properties) == properties)
            return i;
    return UINT32_MAX;
}

enum status vulkan_buffer_create(struct vulkan_context *context, VkDeviceSize size, VkBufferUsageFlags usage,
                                 const VkMemoryPropertyFlags *property_sets, struct vulkan_buffer *buffer)
{
    *buffer = (struct vulkan_buffer){0};
    VULKAN_CALL(vkCreateBuffer, context->device,
                &(VkBufferCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                    .size = size,
                    .usage = usage,
                },
                NULL, &buffer->buffer);
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(context->device, buffer->buffer, &requirements);
    uint32_t type = find_memory_type(context, requirements.memoryTypeBits, *property_sets);
    while (type == UINT32_MAX && *property_sets != 0)
        type = find_memory_type(context, requirements.memoryTypeBits, *++property_sets);
    VkResult result = vkAllocateMemory(context->device,
                                       &(VkMemoryAllocateInfo){
                                           .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                           .allocationSize = requirements.size,
                                           .memoryTypeIndex = type,
                                       },
                                       NULL, &buffer->memory);
    if (result != VK_SUCCESS) {
        log_error("vkAllocateMemory: %s for %" PRIu64 " bytes", vulkan_result_name(result),
                  (uint64_t)requirements.size);
        goto error;
    }
    VULKAN_CALL(vkBindBufferMemory, context->device, buffer->buffer, buffer->memory, 0);
    buffer->properties = context->memory.memoryTypes[type].propertyFlags;
    if (buffer->properties & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
        VULKAN_CALL(vkMapMemory, context->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped);
    return STATUS_DONE;

error:
    vulkan_buffer_destroy(context, buffer);
    return STATUS_UNABLE;
}

void vulkan_buffer_destroy(struct vulkan_context *context, struct vulkan_buffer *buffer)
{
    vkDestroyBuffer(context->device, buffer->buffer, NULL);
    vkFreeMemory(context->device, buffer->memory, NULL);
    *buffer = (struct vulkan_buffer){0};
}
