#include "vulkan/pass.h"

#include <string.h>

#include "base/clock.h"
#include "vulkan/buffer.h"

enum { STARTED, ENDED, TIMESTAMPS };

/* The set, and the layouts of set and pipeline. */
static enum status create_set(struct vulkan_pass *pass, const struct pass_info *info)
{
    const VkDevice device = pass->context->device;
    VkDescriptorSetLayoutBinding bindings[PASS_MOST_BINDINGS];
    VkWriteDescriptorSet writes[PASS_MOST_BINDINGS];
    for (uint32_t i = 0; i < info->binding_count; ++i)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = info->bindings[i].type,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    VULKAN_CALL(vkCreateDescriptorSetLayout, device,
                &(VkDescriptorSetLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                    .bindingCount = info->binding_count,
                    .pBindings = bindings,
                },
                NULL, &pass->set_layout);
    VULKAN_CALL(vkCreatePipelineLayout, device,
                &(VkPipelineLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                    .setLayoutCount = 1,
                    .pSetLayouts = &pass->set_layout,
                    .pushConstantRangeCount = info->push_constant_size > 0 ? 1 : 0,
                    .pPushConstantRanges =
                        &(VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0, info->push_constant_size},
                },
                NULL, &pass->layout);
    VULKAN_CALL(
        vkCreateDescriptorPool, device,
        &(VkDescriptorPoolCreateInfo){
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
            .maxSets = 1,
            .poolSizeCount = 2,
            .pPoolSizes = (VkDescriptorPoolSize[]){{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, PASS_MOST_BINDINGS},
                                                   {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, PASS_MOST_BINDINGS}},
        },
        NULL, &pass->descriptor_pool);
    VULKAN_CALL(vkAllocateDescriptorSets, device,
                &(VkDescriptorSetAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                    .descriptorPool = pass->descriptor_pool,
                    .descriptorSetCount = 1,
                    .pSetLayouts = &pass->set_layout,
                },
                &pass->set);
    vulkan_name(pass->context, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)pass->set, info->name);
    for (uint32_t i = 0; i < info->binding_count; ++i)
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = pass->set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = info->bindings[i].type,
            .pBufferInfo = &info->bindings[i].memory,
        };
    vkUpdateDescriptorSets(device, info->binding_count, writes, 0, NULL);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static enum status create_pipeline(struct vulkan_pass *pass, const struct pass_info *info)
{
    const VkDevice device = pass->context->device;
    VkShaderModule module = VK_NULL_HANDLE;
    VkSpecializationMapEntry entries[PASS_MOST_CONSTANTS];
    for (uint32_t i = 0; i < info->constant_count; ++i)
        entries[i] = (VkSpecializationMapEntry){
            .constantID = info->constants[i].id,
            .offset = (uint32_t)(i * sizeof *info->constants + offsetof(struct pass_constant, value)),
            .size = sizeof info->constants->value,
        };
    VULKAN_CALL(vkCreateShaderModule, device,
                &(VkShaderModuleCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                    .codeSize = info->code.size,
                    .pCode = info->code.words,
                },
                NULL, &module);
    VULKAN_CALL(vkCreateComputePipelines, device, VK_NULL_HANDLE, 1,
                &(VkComputePipelineCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                    .stage =
                        {
                            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                            .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                            .module = module,
                            .pName = "main",
                            .pSpecializationInfo =
                                &(VkSpecializationInfo){
                                    .mapEntryCount = info->constant_count,
                                    .pMapEntries = entries,
                                    .dataSize = info->constant_count * sizeof *info->constants,
                                    .pData = info->constants,
                                },
                        },
                    .layout = pass->layout,
                },
                NULL, &pass->pipeline);
    vkDestroyShaderModule(device, module, NULL);
    vulkan_name(pass->context, VK_OBJECT_TYPE_PIPELINE, (uint64_t)pass->pipeline, info->name);
    return STATUS_DONE;

error:
    vkDestroyShaderModule(device, module, NULL);
    return STATUS_UNABLE;
}

static enum status create_commands(struct vulkan_pass *pass, const char *name)
{
    const VkDevice device = pass->context->device;
    VULKAN_CALL(vkCreateCommandPool, device,
                &(VkCommandPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                    .queueFamilyIndex = pass->context->queue_family,
                },
                NULL, &pass->command_pool);
    VULKAN_CALL(vkAllocateCommandBuffers, device,
                &(VkCommandBufferAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                    .commandPool = pass->command_pool,
                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                    .commandBufferCount = 1,
                },
                &pass->commands);
    if (pass->context->timestamp_bits > 0)
        VULKAN_CALL(vkCreateQueryPool, device,
                    &(VkQueryPoolCreateInfo){
                        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                        .queryCount = TIMESTAMPS,
                    },
                    NULL, &pass->timestamps);
    VULKAN_CALL(vkCreateFence, device, &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                NULL, &pass->fence);
    vulkan_name(pass->context, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)pass->commands, name);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_pass_create(struct vulkan_context *context, const struct pass_info *info,
                               struct vulkan_pass *pass)
{
    *pass = (struct vulkan_pass){.context = context, .push_constant_size = info->push_constant_size};
    enum status status = create_set(pass, info);
    if (status == STATUS_DONE)
        status = create_pipeline(pass, info);
    if (status == STATUS_DONE)
        status = create_commands(pass, info->name);
    if (status != STATUS_DONE)
        vulkan_pass_destroy(pass);
    return status;
}

void vulkan_pass_destroy(struct vulkan_pass *pass)
{
    if (!pass->context)
        return;
    const VkDevice device = pass->context->device;
    vkDestroyFence(device, pass->fence, NULL);
    vkDestroyQueryPool(device, pass->timestamps, NULL);
    vkDestroyCommandPool(device, pass->command_pool, NULL);
    vkDestroyPipeline(device, pass->pipeline, NULL);
    vkDestroyDescriptorPool(device, pass->descriptor_pool, NULL);
    vkDestroyPipelineLayout(device, pass->layout, NULL);
    vkDestroyDescriptorSetLayout(device, pass->set_layout, NULL);
    *pass = (struct vulkan_pass){0};
}

/* All that was written on the device so far is seen by what follows, and by the host. */
static void record_barrier(VkCommandBuffer commands)
{
    const VkPipelineStageFlags device = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    vkCmdPipelineBarrier(commands, device, device | VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &(VkMemoryBarrier){
                             .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                             .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                             .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                         },
                         0, NULL, 0, NULL);
}

static void record(const struct vulkan_pass *pass, const struct pass_dispatch *dispatch)
{
    const VkCommandBuffer commands = pass->commands;
    record_barrier(commands);
    if (pass->timestamps)
        vkCmdResetQueryPool(commands, pass->timestamps, 0, TIMESTAMPS);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pass->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pass->layout, 0, 1, &pass->set, 0,
                            NULL);
    if (pass->push_constant_size > 0)
        vkCmdPushConstants(commands, pass->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, pass->push_constant_size,
                           dispatch->push_constants);
    if (pass->timestamps)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, pass->timestamps, STARTED);
    vkCmdDispatch(commands, dispatch->groups_x, dispatch->groups_y, 1);
    if (pass->timestamps)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pass->timestamps, ENDED);
    record_barrier(commands);
    if (dispatch->copy_to) {
        vkCmdCopyBuffer(commands, dispatch->copy_from, dispatch->copy_to, 1,
                        &(VkBufferCopy){.size = dispatch->copy_size});
        record_barrier(commands);
    }
}

enum status vulkan_pass_run(struct vulkan_pass *pass, const struct pass_dispatch *dispatch, double *device_ms)
{
    const struct vulkan_context *context = pass->context;
    VULKAN_CALL(vkBeginCommandBuffer, pass->commands,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    record(pass, dispatch);
    vulkan_end_frame(pass->context, pass->commands);
    VULKAN_CALL(vkEndCommandBuffer, pass->commands);
    double start = clock_ms();
    VULKAN_CALL(vkQueueSubmit, context->queue, 1,
                &(VkSubmitInfo){
                    .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 1,
                    .pCommandBuffers = &pass->commands,
                },
                pass->fence);
    VULKAN_CALL(vkWaitForFences, context->device, 1, &pass->fence, VK_TRUE, UINT64_MAX);
    VULKAN_CALL(vkResetFences, context->device, 1, &pass->fence);
    *device_ms = clock_ms() - start;
    if (pass->timestamps) {
        uint64_t ticks[TIMESTAMPS];
        VULKAN_CALL(vkGetQueryPoolResults, context->device, pass->timestamps, 0, TIMESTAMPS, sizeof ticks,
                    ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        uint64_t mask = UINT64_MAX >> (64 - context->timestamp_bits);
        *device_ms = (double)((ticks[ENDED] - ticks[STARTED]) & mask) *
                     (double)context->properties.limits.timestampPeriod * 1e-6;
    }
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job)
{
    struct vulkan_buffer input = {0}, output = {0};
    struct vulkan_pass pass = {0};
    struct pass_info info = job->pass;
    double unused_ms;
    enum status status = STATUS_UNABLE;
    if (vulkan_buffer_create(context, "input", job->input_size, BUFFER_UPLOAD, &input) != STATUS_DONE ||
        vulkan_buffer_create(context, "output", job->output_size, BUFFER_READBACK, &output) != STATUS_DONE)
        goto end;
    memcpy(input.mapped, job->input, job->input_size);
    info.bindings = (struct pass_binding[]){
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {input.buffer, 0, VK_WHOLE_SIZE}},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {output.buffer, 0, VK_WHOLE_SIZE}},
    };
    info.binding_count = 2;
    status = vulkan_pass_create(context, &info, &pass);
    if (status == STATUS_DONE)
        status = vulkan_pass_run(&pass, &(struct pass_dispatch){.groups_x = job->groups, .groups_y = 1},
                                 &unused_ms);
    if (status == STATUS_DONE)
        memcpy(job->output, output.mapped, job->output_size);

end:
    vulkan_pass_destroy(&pass);
    vulkan_buffer_destroy(context, &output);
    vulkan_buffer_destroy(context, &input);
    return status;
}
