#include "vulkan/pipeline.h"

enum { MOST_CONSTANTS = 32 };

enum status vulkan_pipeline_create(struct vulkan_context *context, struct spirv code, VkPipelineLayout layout,
                                   const uint32_t *constants, uint32_t constant_count, VkPipeline *pipeline)
{
    VkShaderModule module = VK_NULL_HANDLE;
    VkSpecializationMapEntry entries[MOST_CONSTANTS];
    if (constant_count > MOST_CONSTANTS) {
        log_error("%u specialization constants, room for %d", constant_count, MOST_CONSTANTS);
        return STATUS_UNABLE;
    }
    for (uint32_t i = 0; i < constant_count; ++i)
        entries[i] = (VkSpecializationMapEntry){i, i * (uint32_t)sizeof(uint32_t), sizeof(uint32_t)};
    VULKAN_CALL(vkCreateShaderModule, context->device,
                &(VkShaderModuleCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                    .codeSize = code.size,
                    .pCode = code.words,
                },
                NULL, &module);
    VULKAN_CALL(vkCreateComputePipelines, context->device, VK_NULL_HANDLE, 1,
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
                                    .mapEntryCount = constant_count,
                                    .pMapEntries = entries,
                                    .dataSize = constant_count * sizeof *constants,
                                    .pData = constants,
                                },
                        },
                    .layout = layout,
                },
                NULL, pipeline);
    vkDestroyShaderModule(context->device, module, NULL);
    return STATUS_DONE;

error:
    vkDestroyShaderModule(context->device, module, NULL);
    return STATUS_UNABLE;
}
