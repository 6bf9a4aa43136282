#include "vulkan/command.h"

#include "base/clock.h"

enum status vulkan_command_create(struct vulkan_context *context, struct vulkan_command *command)
{
    const VkDevice device = context->device;
    *command = (struct vulkan_command){.context = context};
    VULKAN_CALL(vkCreateCommandPool, device,
                &(VkCommandPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                    .queueFamilyIndex = context->queue_family,
                },
                NULL, &command->pool);
    VULKAN_CALL(vkAllocateCommandBuffers, device,
                &(VkCommandBufferAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                    .commandPool = command->pool,
                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                    .commandBufferCount = 1,
                },
                &command->buffer);
    if (context->timestamp_bits > 0)
        VULKAN_CALL(vkCreateQueryPool, device,
                    &(VkQueryPoolCreateInfo){
                        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                        .queryCount = TIMESTAMPS,
                    },
                    NULL, &command->timestamps);
    VULKAN_CALL(vkCreateFence, device, &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                NULL, &command->fence);
    return STATUS_DONE;

error:
    vulkan_command_destroy(command);
    return STATUS_UNABLE;
}

void vulkan_command_destroy(struct vulkan_command *command)
{
    if (!command->context)
        return;
    const VkDevice device = command->context->device;
    vkDestroyFence(device, command->fence, NULL);
    vkDestroyQueryPool(device, command->timestamps, NULL);
    vkDestroyCommandPool(device, command->pool, NULL);
    *command = (struct vulkan_command){0};
}

void vulkan_record_barrier(VkCommandBuffer commands, VkPipelineStageFlags to, VkAccessFlags accesses)
{
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT, to,
                         0, 1,
                         &(VkMemoryBarrier){
                             .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                             .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                             .dstAccessMask = accesses,
                         },
                         0, NULL, 0, NULL);
}

enum status vulkan_command_begin(struct vulkan_command *command, const char *label)
{
    VULKAN_CALL(vkBeginCommandBuffer, command->buffer,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    command->context->begin_label(command->buffer, &(VkDebugUtilsLabelEXT){
                                                       .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                                       .pLabelName = label,
                                                   });
    vulkan_record_barrier(command->buffer,
                          VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                              VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    if (command->timestamps)
        vkCmdResetQueryPool(command->buffer, command->timestamps, 0, TIMESTAMPS);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_command_submit(struct vulkan_command *command)
{
    vulkan_record_barrier(command->buffer, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    command->context->end_label(command->buffer);
    VULKAN_CALL(vkEndCommandBuffer, command->buffer);
    command->submitted_ms = clock_ms();
    VULKAN_CALL(vkQueueSubmit, command->context->queue, 1,
                &(VkSubmitInfo){
                    .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 1,
                    .pCommandBuffers = &command->buffer,
                },
                command->fence);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_command_wait(struct vulkan_command *command, double *device_ms)
{
    struct vulkan_context *context = command->context;
    VULKAN_CALL(vkWaitForFences, context->device, 1, &command->fence, VK_TRUE, UINT64_MAX);
    VULKAN_CALL(vkResetFences, context->device, 1, &command->fence);
    *device_ms = clock_ms() - command->submitted_ms;
    if (command->timestamps) {
        uint64_t ticks[TIMESTAMPS];
        VULKAN_CALL(vkGetQueryPoolResults, context->device, command->timestamps, 0, TIMESTAMPS, sizeof ticks,
                    ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        uint64_t mask = UINT64_MAX >> (64 - context->timestamp_bits);
        *device_ms = (double)((ticks[ENDED] - ticks[STARTED]) & mask) *
                     (double)context->properties.limits.timestampPeriod * 1e-6;
    }
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}
