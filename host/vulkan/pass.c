#include "vulkan/pass.h"

#include <string.h>

#include "vulkan/buffer.h"

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

enum status vulkan_pass_create(struct vulkan_context *context, const struct pass_info *info,
                               struct vulkan_pass *pass)
{
    *pass = (struct vulkan_pass){.context = context, .push_constant_size = info->push_constant_size};
    enum status status = create_set(pass, info);
    if (status == STATUS_DONE)
        status = create_pipeline(pass, info);
    if (status != STATUS_DONE)
        vulkan_pass_destroy(pass);
    return status;
}

void vulkan_pass_destroy(struct vulkan_pass *pass)
{
    if (!pass->context)
        return;
    const VkDevice device = pass->context->device;
    vkDestroyPipeline(device, pass->pipeline, NULL);
    vkDestroyDescriptorPool(device, pass->descriptor_pool, NULL);
    vkDestroyPipelineLayout(device, pass->layout, NULL);
    vkDestroyDescriptorSetLayout(device, pass->set_layout, NULL);
    *pass = (struct vulkan_pass){0};
}

void vulkan_pass_record(const struct vulkan_pass *pass, const struct vulkan_command *command,
                        const void *push_constants, uint32_t groups_x, uint32_t groups_y)
{
    vkCmdBindPipeline(command->buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pass->pipeline);
    vkCmdBindDescriptorSets(command->buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pass->layout, 0, 1, &pass->set,
                            0, NULL);
    if (pass->push_constant_size > 0)
        vkCmdPushConstants(command->buffer, pass->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           pass->push_constant_size, push_constants);
    if (command->timestamps)
        vkCmdWriteTimestamp(command->buffer, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, command->timestamps, STARTED);
    vkCmdDispatch(command->buffer, groups_x, groups_y, 1);
    if (command->timestamps)
        vkCmdWriteTimestamp(command->buffer, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, command->timestamps,
                            ENDED);
}

enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job)
{
    struct vulkan_buffer input = {0}, output = {0};
    struct vulkan_pass pass = {0};
    struct vulkan_command command = {0};
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
    if (vulkan_pass_create(context, &info, &pass) != STATUS_DONE ||
        vulkan_command_create(context, &command) != STATUS_DONE ||
        vulkan_command_begin(&command, info.name) != STATUS_DONE)
        goto end;
    vulkan_pass_record(&pass, &command, NULL, job->groups, 1);
    status = vulkan_command_run(&command, &unused_ms);
    if (status == STATUS_DONE)
        memcpy(job->output, output.mapped, job->output_size);

end:
    vulkan_command_destroy(&command);
    vulkan_pass_destroy(&pass);
    vulkan_buffer_destroy(context, &output);
    vulkan_buffer_destroy(context, &input);
    return status;
}
