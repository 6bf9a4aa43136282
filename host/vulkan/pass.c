#include "vulkan/pass.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "vulkan/buffer.h"

enum { STARTED, ENDED, TIMESTAMPS };

static enum status create_layouts(struct vulkan_pass *pass)
{
    struct vulkan_context *context = pass->context;
    VkDescriptorSetLayoutBinding bindings[PASS_MOST_BINDINGS];
    for (uint32_t i = 0; i < pass->binding_count; ++i)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = pass->bindings[i],
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    VULKAN_CALL(context, vkCreateDescriptorSetLayout, context->device,
                &(VkDescriptorSetLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                    .bindingCount = pass->binding_count,
                    .pBindings = bindings,
                },
                NULL, &pass->set_layout);
    VULKAN_CALL(context, vkCreatePipelineLayout, context->device,
                &(VkPipelineLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                    .setLayoutCount = 1,
                    .pSetLayouts = &pass->set_layout,
                    .pushConstantRangeCount = pass->push_constant_size > 0 ? 1 : 0,
                    .pPushConstantRanges =
                        &(VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0, pass->push_constant_size},
                },
                NULL, &pass->layout);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static enum status create_pipeline(struct vulkan_pass *pass, const struct pass_info *info)
{
    struct vulkan_context *context = pass->context;
    VkShaderModule module = VK_NULL_HANDLE;
    struct spirv declared = info->fast ? (struct spirv){0} : float_controls_declare(context, info->code);
    const struct spirv code = info->fast ? info->code : declared;
    if (!code.words)
        return STATUS_UNABLE;
    VkSpecializationMapEntry entries[PASS_MOST_CONSTANTS];
    for (uint32_t i = 0; i < info->constant_count; ++i)
        entries[i] = (VkSpecializationMapEntry){
            .constantID = info->constants[i].id,
            .offset = (uint32_t)(i * sizeof *info->constants + offsetof(struct pass_constant, value)),
            .size = sizeof info->constants->value,
        };
    VULKAN_CALL(context, vkCreateShaderModule, context->device,
                &(VkShaderModuleCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                    .codeSize = code.size,
                    .pCode = code.words,
                },
                NULL, &module);
    VULKAN_CALL(context, vkCreateComputePipelines, context->device, VK_NULL_HANDLE, 1,
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
    vkDestroyShaderModule(context->device, module, NULL);
    free((void *)(uintptr_t)declared.words);
    vulkan_name(pass->context, VK_OBJECT_TYPE_PIPELINE, (uint64_t)pass->pipeline, info->name);
    return STATUS_DONE;

error:
    vkDestroyShaderModule(context->device, module, NULL);
    free((void *)(uintptr_t)declared.words);
    return STATUS_UNABLE;
}

enum status vulkan_pass_create(struct vulkan_context *context, const struct pass_info *info,
                               struct vulkan_pass *pass)
{
    *pass = (struct vulkan_pass){
        .context = context,
        .binding_count = info->binding_count,
        .push_constant_size = info->push_constant_size,
    };
    memcpy(pass->bindings, info->bindings, info->binding_count * sizeof *info->bindings);
    enum status status = create_layouts(pass);
    if (status == STATUS_DONE)
        status = create_pipeline(pass, info);
    if (status != STATUS_DONE)
        vulkan_pass_destroy(pass);
    return status;
}

void vulkan_pass_destroy(struct vulkan_pass *pass)
{
    if (pass->context && !pass->context->hung) {
        const VkDevice device = pass->context->device;
        vkDestroyPipeline(device, pass->pipeline, NULL);
        vkDestroyPipelineLayout(device, pass->layout, NULL);
        vkDestroyDescriptorSetLayout(device, pass->set_layout, NULL);
    }
    *pass = (struct vulkan_pass){0};
}

static enum status create_set(struct pass_frame *frame, const VkDescriptorBufferInfo *buffers,
                              const VkBufferView *texels)
{
    const struct vulkan_pass *pass = frame->pass;
    struct vulkan_context *context = pass->context;
    VkWriteDescriptorSet writes[PASS_MOST_BINDINGS];
    VULKAN_CALL(
        context, vkCreateDescriptorPool, context->device,
        &(VkDescriptorPoolCreateInfo){
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
            .maxSets = 1,
            .poolSizeCount = 3,
            .pPoolSizes =
                (VkDescriptorPoolSize[]){{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, PASS_MOST_BINDINGS},
                                         {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, PASS_MOST_BINDINGS},
                                         {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, PASS_MOST_BINDINGS}},
        },
        NULL, &frame->descriptor_pool);
    VULKAN_CALL(context, vkAllocateDescriptorSets, context->device,
                &(VkDescriptorSetAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                    .descriptorPool = frame->descriptor_pool,
                    .descriptorSetCount = 1,
                    .pSetLayouts = &pass->set_layout,
                },
                &frame->set);
    uint32_t count = 0;
    for (uint32_t i = 0; i < pass->binding_count; ++i) {
        const bool is_texels = pass->bindings[i] == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        if (is_texels ? texels && texels[i] : buffers[i].buffer != VK_NULL_HANDLE)
            writes[count++] = (VkWriteDescriptorSet){
                .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                .dstSet = frame->set,
                .dstBinding = i,
                .descriptorCount = 1,
                .descriptorType = pass->bindings[i],
                .pBufferInfo = &buffers[i],
                .pTexelBufferView = is_texels ? &texels[i] : NULL,
            };
    }
    vkUpdateDescriptorSets(context->device, count, writes, 0, NULL);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static enum status create_commands(struct pass_frame *frame)
{
    struct vulkan_context *context = frame->pass->context;
    VULKAN_CALL(context, vkCreateCommandPool, context->device,
                &(VkCommandPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                    .queueFamilyIndex = context->queue_family,
                },
                NULL, &frame->command_pool);
    VULKAN_CALL(context, vkAllocateCommandBuffers, context->device,
                &(VkCommandBufferAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                    .commandPool = frame->command_pool,
                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                    .commandBufferCount = 1,
                },
                &frame->commands);
    if (context->timestamp_bits > 0)
        VULKAN_CALL(context, vkCreateQueryPool, context->device,
                    &(VkQueryPoolCreateInfo){
                        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                        .queryCount = TIMESTAMPS,
                    },
                    NULL, &frame->timestamps);
    VULKAN_CALL(context, vkCreateFence, context->device,
                &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO}, NULL, &frame->fence);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status pass_frame_create(const struct vulkan_pass *pass, const VkDescriptorBufferInfo *buffers,
                              const VkBufferView *texels, struct pass_frame *frame)
{
    *frame = (struct pass_frame){.pass = pass};
    enum status status = create_set(frame, buffers, texels);
    if (status == STATUS_DONE)
        status = create_commands(frame);
    if (status != STATUS_DONE)
        pass_frame_destroy(frame);
    return status;
}

void pass_frame_destroy(struct pass_frame *frame)
{
    if (frame->pass && !frame->pass->context->hung) {
        const VkDevice device = frame->pass->context->device;
        vkDestroyFence(device, frame->fence, NULL);
        vkDestroyQueryPool(device, frame->timestamps, NULL);
        vkDestroyCommandPool(device, frame->command_pool, NULL);
        vkDestroyDescriptorPool(device, frame->descriptor_pool, NULL);
    }
    *frame = (struct pass_frame){0};
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

static void record(const struct pass_frame *frame, const struct pass_dispatch *dispatch)
{
    const struct vulkan_pass *pass = frame->pass;
    const VkCommandBuffer commands = frame->commands;
    record_barrier(commands);
    if (frame->timestamps)
        vkCmdResetQueryPool(commands, frame->timestamps, 0, TIMESTAMPS);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pass->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pass->layout, 0, 1, &frame->set, 0,
                            NULL);
    if (pass->push_constant_size > 0 && dispatch->push_constants)
        vkCmdPushConstants(commands, pass->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, pass->push_constant_size,
                           dispatch->push_constants);
    if (frame->timestamps)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, frame->timestamps, STARTED);
    if (dispatch->groups_x > 0)
        vkCmdDispatch(commands, dispatch->groups_x, dispatch->groups_y, 1);
    if (frame->timestamps)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, frame->timestamps, ENDED);
    record_barrier(commands);
    if (dispatch->copy_to) {
        vkCmdCopyBuffer(commands, dispatch->copy_from, dispatch->copy_to, 1,
                        &(VkBufferCopy){.size = dispatch->copy_size});
        record_barrier(commands);
    }
}

enum status pass_frame_submit(struct pass_frame *frame, const struct pass_dispatch *dispatch)
{
    struct vulkan_context *context = frame->pass->context;
    VULKAN_CALL(context, vkBeginCommandBuffer, frame->commands,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    record(frame, dispatch);
    vulkan_end_frame(context, frame->commands);
    VULKAN_CALL(context, vkEndCommandBuffer, frame->commands);
    frame->submitted_ms = clock_ms();
    VULKAN_CALL(context, vkQueueSubmit, context->queue, 1,
                &(VkSubmitInfo){
                    .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 1,
                    .pCommandBuffers = &frame->commands,
                },
                frame->fence);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* Sleeps for a part of the time that has been waited, in nanoseconds: short enough to add little to it. */
static void rest(double waited_ms)
{
    const double ns = waited_ms * 1e6 / 64;
    nanosleep(&(struct timespec){.tv_nsec = ns < 2e4 ? 20000 : ns > 5e6 ? 5000000 : (long)ns}, NULL);
}

/* Lavapipe spins where it is to wait for a limited time, and takes a processor from the shader. */
enum status pass_frame_wait(struct pass_frame *frame, double *device_ms)
{
    struct vulkan_context *context = frame->pass->context;
    VkResult result = vkGetFenceStatus(context->device, frame->fence);
    while (result == VK_NOT_READY) {
        rest(clock_ms() - frame->submitted_ms);
        result = vkGetFenceStatus(context->device, frame->fence);
    }
    if (result != VK_SUCCESS && result != VK_ERROR_DEVICE_LOST)
        context->hung = true;
    double waited_ms = clock_ms() - frame->submitted_ms;
    if (result != VK_SUCCESS) {
        vulkan_report(context, "vkGetFenceStatus", result);
        return STATUS_UNABLE;
    }
    VULKAN_CALL(context, vkResetFences, context->device, 1, &frame->fence);
    if (frame->timestamps) {
        uint64_t ticks[TIMESTAMPS];
        VULKAN_CALL(context, vkGetQueryPoolResults, context->device, frame->timestamps, 0, TIMESTAMPS,
                    sizeof ticks, ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        uint64_t mask = UINT64_MAX >> (64 - context->timestamp_bits);
        waited_ms = (double)((ticks[ENDED] - ticks[STARTED]) & mask) *
                    (double)context->properties.limits.timestampPeriod * 1e-6;
    }
    if (device_ms)
        *device_ms = waited_ms;
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job)
{
    static const VkDescriptorType bindings[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    struct vulkan_buffer input = {0}, output = {0};
    struct vulkan_pass pass = {0};
    struct pass_frame frame = {0};
    struct pass_info info = job->pass;
    info.bindings = bindings;
    info.binding_count = 2;
    enum status status = vulkan_buffer_create(context, "input", job->input_size, BUFFER_UPLOAD, &input);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(context, "output", job->output_size, BUFFER_READBACK, &output);
    if (status == STATUS_DONE)
        status = vulkan_pass_create(context, &info, &pass);
    if (status == STATUS_DONE)
        status = pass_frame_create(
            &pass,
            (VkDescriptorBufferInfo[]){{input.buffer, 0, VK_WHOLE_SIZE}, {output.buffer, 0, VK_WHOLE_SIZE}},
            NULL, &frame);
    if (status == STATUS_DONE) {
        memcpy(input.mapped, job->input, job->input_size);
        status = pass_frame_submit(&frame, &(struct pass_dispatch){.groups_x = job->groups, .groups_y = 1});
    }
    if (status == STATUS_DONE)
        status = pass_frame_wait(&frame, NULL);
    if (status == STATUS_DONE)
        memcpy(job->output, output.mapped, job->output_size);
    pass_frame_destroy(&frame);
    vulkan_pass_destroy(&pass);
    vulkan_buffer_destroy(context, &output);
    vulkan_buffer_destroy(context, &input);
    return status;
}
