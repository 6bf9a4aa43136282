/* To be loaded before the Vulkan loader: no compute pipeline is built while there is a file "no_pipelines" in
 * the working folder. */
#include <dlfcn.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

VKAPI_ATTR VkResult VKAPI_CALL vkCreateComputePipelines(VkDevice device, VkPipelineCache cache,
                                                        uint32_t count,
                                                        const VkComputePipelineCreateInfo *infos,
                                                        const VkAllocationCallbacks *allocator,
                                                        VkPipeline *pipelines)
{
    PFN_vkCreateComputePipelines create;
    *(void **)&create = dlsym(RTLD_NEXT, "vkCreateComputePipelines");
    return access("no_pipelines", F_OK) == 0 ? VK_ERROR_OUT_OF_DEVICE_MEMORY
                                             : create(device, cache, count, infos, allocator, pipelines);
}
