#include "vulkan/buffer.h"

#include <inttypes.h>
#include <stdio.h>

enum {
    LOCAL = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
    HOST = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
    CACHED = HOST | VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
};

/* The best of the allowed memory types: of many graphics cards the host sees 256 MiB. Each device has one for
 * the last of each row (Vulkan 1.3, 11.2.1). */
static uint32_t find_memory_type(const struct vulkan_context *context,
                                 const VkMemoryRequirements *requirements, enum buffer_memory memory)
{
    static const VkMemoryPropertyFlags preferences[][3] = {
        [BUFFER_DEVICE] = {LOCAL | CACHED, LOCAL, 0},
        [BUFFER_UPLOAD] = {LOCAL | HOST, HOST, HOST},
        [BUFFER_READBACK] = {CACHED, HOST, HOST},
    };
    for (int preference = 0; preference < 3; ++preference) {
        VkMemoryPropertyFlags wanted = preferences[memory][preference];
        for (uint32_t i = 0; i < context->memory.memoryTypeCount; ++i) {
            const VkMemoryType *type = &context->memory.memoryTypes[i];
            if (requirements->memoryTypeBits >> i & 1 && (type->propertyFlags & wanted) == wanted &&
                context->memory.memoryHeaps[type->heapIndex].size >= requirements->size)
                return i;
        }
    }
    return 0;
}

enum status vulkan_buffer_create(struct vulkan_context *context, const char *name, VkDeviceSize size,
                                 enum buffer_memory memory, struct vulkan_buffer *buffer)
{
    *buffer = (struct vulkan_buffer){0};
    VULKAN_CALL(context, vkCreateBuffer, context->device,
                &(VkBufferCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                    .size = size,
                    .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                             VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                },
                NULL, &buffer->buffer);
    vulkan_name(context, VK_OBJECT_TYPE_BUFFER, (uint64_t)buffer->buffer, name);
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(context->device, buffer->buffer, &requirements);
    uint32_t type = find_memory_type(context, &requirements, memory);
    VkResult result = vkAllocateMemory(context->device,
                                       &(VkMemoryAllocateInfo){
                                           .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                           .allocationSize = requirements.size,
                                           .memoryTypeIndex = type,
                                       },
                                       NULL, &buffer->memory);
    if (result != VK_SUCCESS) {
        char call[64];
        snprintf(call, sizeof call, "vkAllocateMemory of %" PRIu64 " bytes", (uint64_t)requirements.size);
        vulkan_report(context, call, result);
        goto error;
    }
    VULKAN_CALL(context, vkBindBufferMemory, context->device, buffer->buffer, buffer->memory, 0);
    if (memory != BUFFER_DEVICE || (context->memory.memoryTypes[type].propertyFlags & CACHED) == CACHED)
        VULKAN_CALL(context, vkMapMemory, context->device, buffer->memory, 0, VK_WHOLE_SIZE, 0,
                    &buffer->mapped);
    return STATUS_DONE;

error:
    vulkan_buffer_destroy(context, buffer);
    return STATUS_UNABLE;
}

void vulkan_buffer_destroy(struct vulkan_context *context, struct vulkan_buffer *buffer)
{
    if (!context->hung) {
        vkDestroyBuffer(context->device, buffer->buffer, NULL);
        vkFreeMemory(context->device, buffer->memory, NULL);
    }
    *buffer = (struct vulkan_buffer){0};
}

enum status vulkan_texels_create(struct vulkan_context *context, VkDescriptorBufferInfo part, VkFormat format,
                                 VkBufferView *view)
{
    VULKAN_CALL(context, vkCreateBufferView, context->device,
                &(VkBufferViewCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                    .buffer = part.buffer,
                    .format = format,
                    .offset = part.offset,
                    .range = part.range,
                },
                NULL, view);
    return STATUS_DONE;

error:
    *view = VK_NULL_HANDLE;
    return STATUS_UNABLE;
}

void vulkan_texels_destroy(struct vulkan_context *context, VkBufferView *view)
{
    if (!context->hung)
        vkDestroyBufferView(context->device, *view, NULL);
    *view = VK_NULL_HANDLE;
}
