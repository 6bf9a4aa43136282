#include "vulkan/pass.h"

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
