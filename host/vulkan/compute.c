#include "vulkan/compute.h"

#include <string.h>

#include "vulkan/buffer.h"
#include "vulkan/pipeline.h"

enum { INPUT, OUTPUT_BUFFER, BUFFERS };

/* What exists while a job runs. */
struct running {
    VkDevice device;
    struct vulkan_buffer buffers[BUFFERS];
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout pipeline_layout;
    VkPipeline pipeline;
    VkDescriptorPool descriptor_pool;
    VkDescriptorSet set;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkFence fence;
};

static enum status create_buffers(struct vulkan_context *context, struct running *running,
                                  const struct compute_job *job)
{
    const VkMemoryPropertyFlags visible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkDeviceSize sizes[BUFFERS] = {job->input_size, job->output_size};
    enum status status = STATUS_DONE;
    for (int i = 0; i < BUFFERS && status == STATUS_DONE; ++i)
        status = vulkan_buffer_create(
            context, sizes[i], VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            (VkMemoryPropertyFlags[]){visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, visible, 0},
            &running->buffers[i]);
    if (status == STATUS_DONE &&
        (!running->buffers[INPUT].mapped || !running->buffers[OUTPUT_BUFFER].mapped)) {
        log_error("the device has no memory that the host can see");
        status = STATUS_UNABLE;
    }
    if (status == STATUS_DONE)
        memcpy(running->buffers[INPUT].mapped, job->input, job->input_size);
    return status;
}

static enum status create_set(struct running *running)
{
    const VkDevice device = running->device;
    VkDescriptorSetLayoutBinding bindings[BUFFERS];
    for (uint32_t i = 0; i < BUFFERS; ++i)
        bindings[i] = (VkDescriptorSetLayoutBinding){i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                     VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    VULKAN_CALL(vkCreateDescriptorSetLayout, device,
                &(VkDescriptorSetLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                    .bindingCount = BUFFERS,
                    .pBindings = bindings,
                },
                NULL, &running->set_layout);
    VULKAN_CALL(vkCreateDescriptorPool, device,
                &(VkDescriptorPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                    .maxSets = 1,
                    .poolSizeCount = 1,
                    .pPoolSizes = &(VkDescriptorPoolSize){VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFERS},
                },
                NULL, &running->descriptor_pool);
    VULKAN_CALL(vkAllocateDescriptorSets, device,
                &(VkDescriptorSetAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                    .descriptorPool = running->descriptor_pool,
                    .descriptorSetCount = 1,
                    .pSetLayouts = &running->set_layout,
                },
                &running->set);
    for (uint32_t i = 0; i < BUFFERS; ++i)
        vkUpdateDescriptorSets(device, 1,
                               &(VkWriteDescriptorSet){
                                   .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = running->set,
                                   .dstBinding = i,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                   .pBufferInfo =
                                       &(VkDescriptorBufferInfo){
                                           .buffer = running->buffers[i].buffer,
                                           .range = VK_WHOLE_SIZE,
                                       },
                               },
                               0, NULL);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static enum status create_pipeline(struct vulkan_context *context, struct running *running,
                                   const struct compute_job *job)
{
    const VkDevice device = running->device;
    VULKAN_CALL(vkCreatePipelineLayout, device,
                &(VkPipelineLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                    .setLayoutCount = 1,
                    .pSetLayouts = &running->set_layout,
                },
                NULL, &running->pipeline_layout);
    return vulkan_pipeline_create(context, job->code, running->pipeline_layout, job->constants,
                                  job->constant_count, &running->pipeline);

error:
    return STATUS_UNABLE;
}

static enum status submit(struct vulkan_context *context, struct running *running, uint32_t groups)
{
    const VkDevice device = running->device;
    VULKAN_CALL(vkCreateCommandPool, device,
                &(VkCommandPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                    .queueFamilyIndex = context->queue_family,
                },
                NULL, &running->command_pool);
    VULKAN_CALL(vkAllocateCommandBuffers, device,
                &(VkCommandBufferAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                    .commandPool = running->command_pool,
                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                    .commandBufferCount = 1,
                },
                &running->commands);
    VULKAN_CALL(vkCreateFence, device, &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                NULL, &running->fence);
    VULKAN_CALL(vkBeginCommandBuffer, running->commands,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    vkCmdBindPipeline(running->commands, VK_PIPELINE_BIND_POINT_COMPUTE, running->pipeline);
    vkCmdBindDescriptorSets(running->commands, VK_PIPELINE_BIND_POINT_COMPUTE, running->pipeline_layout, 0, 1,
                            &running->set, 0, NULL);
    vkCmdDispatch(running->commands, groups, 1, 1);
    vkCmdPipelineBarrier(running->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                         0, 1,
                         &(VkMemoryBarrier){
                             .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                             .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                             .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
                         },
                         0, NULL, 0, NULL);
    VULKAN_CALL(vkEndCommandBuffer, running->commands);
    VULKAN_CALL(vkQueueSubmit, context->queue, 1,
                &(VkSubmitInfo){
                    .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 1,
                    .pCommandBuffers = &running->commands,
                },
                running->fence);
    VULKAN_CALL(vkWaitForFences, device, 1, &running->fence, VK_TRUE, UINT64_MAX);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job)
{
    struct running running = {.device = context->device};
    const VkDevice device = context->device;
    enum status status = create_buffers(context, &running, job);
    if (status == STATUS_DONE)
        status = create_set(&running);
    if (status == STATUS_DONE)
        status = create_pipeline(context, &running, job);
    if (status == STATUS_DONE)
        status = submit(context, &running, job->groups);
    if (status == STATUS_DONE)
        memcpy(job->output, running.buffers[OUTPUT_BUFFER].mapped, job->output_size);
    vkDestroyFence(device, running.fence, NULL);
    vkDestroyCommandPool(device, running.command_pool, NULL);
    vkDestroyPipeline(device, running.pipeline, NULL);
    vkDestroyPipelineLayout(device, running.pipeline_layout, NULL);
    vkDestroyDescriptorPool(device, running.descriptor_pool, NULL);
    vkDestroyDescriptorSetLayout(device, running.set_layout, NULL);
    vulkan_buffer_destroy(context, &running.buffers[OUTPUT_BUFFER]);
    vulkan_buffer_destroy(context, &running.buffers[INPUT]);
    return status;
}
