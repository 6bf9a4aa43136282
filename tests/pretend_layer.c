/* A Vulkan layer that makes a device look like another, and fail.
 *
 * PRETEND_GPU=1: a discrete graphics card: no memory that the host caches, 64 KiB of uniforms, 128 bytes of
 * push constants, subgroups of 1 without operations, another driver.
 *
 * PRETEND_TEXELS=N: texel buffers have at most so many elements.
 *
 * PRETEND_FAIL=CALL:N:CODE: the N-th call of vkQueueSubmit, vkGetFenceStatus, vkAllocateMemory or
 * vkCreateComputePipelines returns CODE instead; once.
 *
 * PRETEND_AFTER=FILE: calls count from when there is such a file.
 *
 * PRETEND_LOG=FILE: gets a line "X Y" for each dispatch: its groups. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

/* What is below the layer, of one instance with one device at a time. The loader tells it while they are
 * made; later it would tell the layer's own functions. */
static VkInstance the_instance;
static PFN_vkGetInstanceProcAddr next_instance_function;
static PFN_vkGetDeviceProcAddr next_device_function;
static struct {
    PFN_vkGetPhysicalDeviceProperties get_properties;
    PFN_vkGetPhysicalDeviceProperties2 get_properties_2;
    PFN_vkGetPhysicalDeviceMemoryProperties get_memory;
    PFN_vkQueueSubmit queue_submit;
    PFN_vkGetFenceStatus get_fence_status;
    PFN_vkDeviceWaitIdle wait_idle;
    PFN_vkAllocateMemory allocate_memory;
    PFN_vkCreateComputePipelines create_pipelines;
    PFN_vkCmdDispatch dispatch;
} next;

/* What this call of the function is to return; VK_SUCCESS: what the driver says. */
static VkResult planned_failure(const char *name)
{
    static int calls;
    char function[64];
    int turn, code;
    const char *plan = getenv("PRETEND_FAIL");
    if (!plan || sscanf(plan, "%63[^:]:%d:%d", function, &turn, &code) != 3 || strcmp(function, name) != 0)
        return VK_SUCCESS;
    const char *after = getenv("PRETEND_AFTER");
    if (after && access(after, F_OK) != 0)
        return VK_SUCCESS;
    return ++calls == turn ? (VkResult)code : VK_SUCCESS;
}

static bool pretends_gpu(void)
{
    return getenv("PRETEND_GPU") != NULL;
}

static void pretend_properties(VkPhysicalDeviceProperties *properties)
{
    const char *texels = getenv("PRETEND_TEXELS");
    if (texels)
        properties->limits.maxTexelBufferElements = (uint32_t)strtoul(texels, NULL, 10);
    if (!pretends_gpu())
        return;
    properties->deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    snprintf(properties->deviceName, sizeof properties->deviceName, "pretended graphics card");
    properties->limits.maxUniformBufferRange = 65536;
    properties->limits.maxPushConstantsSize = 128;
    properties->limits.maxStorageBufferRange = 1 << 27;
}

static VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                                 VkPhysicalDeviceProperties *properties)
{
    next.get_properties(device, properties);
    pretend_properties(properties);
}

static VKAPI_ATTR void VKAPI_CALL get_properties_2(VkPhysicalDevice device,
                                                   VkPhysicalDeviceProperties2 *properties)
{
    next.get_properties_2(device, properties);
    pretend_properties(&properties->properties);
    for (VkBaseOutStructure *more = properties->pNext; more && pretends_gpu(); more = more->pNext)
        if (more->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES) {
            ((VkPhysicalDeviceSubgroupProperties *)more)->subgroupSize = 1;
            ((VkPhysicalDeviceSubgroupProperties *)more)->supportedOperations = 0;
        } else if (more->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES) {
            ((VkPhysicalDeviceDriverProperties *)more)->driverID = VK_DRIVER_ID_NVIDIA_PROPRIETARY;
        }
}

static VKAPI_ATTR void VKAPI_CALL get_memory(VkPhysicalDevice device,
                                             VkPhysicalDeviceMemoryProperties *memory)
{
    next.get_memory(device, memory);
    for (uint32_t i = 0; pretends_gpu() && i < memory->memoryTypeCount; ++i)
        memory->memoryTypes[i].propertyFlags &= ~(VkFlags)VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
}

static VKAPI_ATTR VkResult VKAPI_CALL queue_submit(VkQueue queue, uint32_t count, const VkSubmitInfo *submits,
                                                   VkFence fence)
{
    VkResult result = planned_failure("vkQueueSubmit");
    return result != VK_SUCCESS ? result : next.queue_submit(queue, count, submits, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL get_fence_status(VkDevice device, VkFence fence)
{
    VkResult result = planned_failure("vkGetFenceStatus");
    if (result != VK_SUCCESS) /* a driver that has lost a device is no longer at work */
        next.wait_idle(device);
    return result != VK_SUCCESS ? result : next.get_fence_status(device, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo *info,
                                                      const VkAllocationCallbacks *allocator,
                                                      VkDeviceMemory *memory)
{
    VkResult result = planned_failure("vkAllocateMemory");
    return result != VK_SUCCESS ? result : next.allocate_memory(device, info, allocator, memory);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                       const VkComputePipelineCreateInfo *infos,
                                                       const VkAllocationCallbacks *allocator,
                                                       VkPipeline *pipelines)
{
    VkResult result = planned_failure("vkCreateComputePipelines");
    return result != VK_SUCCESS ? result
                                : next.create_pipelines(device, cache, count, infos, allocator, pipelines);
}

static VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z)
{
    const char *path = getenv("PRETEND_LOG");
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file) {
        fprintf(file, "%u %u\n", x, y);
        fclose(file);
    }
    next.dispatch(commands, x, y, z);
}

/* The chain of layers in a creation's structures. */
static void *chain_of(const void *structures, VkStructureType type)
{
    const VkLayerInstanceCreateInfo *info = structures;
    while (info && !(info->sType == type && info->function == VK_LAYER_LINK_INFO))
        info = info->pNext;
    return (void *)(uintptr_t)info;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info,
                                                      const VkAllocationCallbacks *allocator,
                                                      VkInstance *instance)
{
    VkLayerInstanceCreateInfo *chain = chain_of(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!chain)
        return VK_ERROR_INITIALIZATION_FAILED;
    next_instance_function = chain->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    chain->u.pLayerInfo = chain->u.pLayerInfo->pNext;
    PFN_vkCreateInstance create = (PFN_vkCreateInstance)next_instance_function(NULL, "vkCreateInstance");
    VkResult result = create(info, allocator, instance);
    if (result != VK_SUCCESS)
        return result;
#define FIND(member, name) next.member = (PFN_##name)next_instance_function(*instance, #name)
    the_instance = *instance;
    FIND(get_properties, vkGetPhysicalDeviceProperties);
    FIND(get_properties_2, vkGetPhysicalDeviceProperties2);
    FIND(get_memory, vkGetPhysicalDeviceMemoryProperties);
#undef FIND
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical_device,
                                                    const VkDeviceCreateInfo *info,
                                                    const VkAllocationCallbacks *allocator, VkDevice *device)
{
    VkLayerDeviceCreateInfo *chain = chain_of(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!chain)
        return VK_ERROR_INITIALIZATION_FAILED;
    next_device_function = chain->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    PFN_vkGetInstanceProcAddr next_of_instance = chain->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    chain->u.pLayerInfo = chain->u.pLayerInfo->pNext;
    PFN_vkCreateDevice create = (PFN_vkCreateDevice)next_of_instance(the_instance, "vkCreateDevice");
    VkResult result = create(physical_device, info, allocator, device);
    if (result != VK_SUCCESS)
        return result;
#define FIND(member, name) next.member = (PFN_##name)next_device_function(*device, #name)
    FIND(queue_submit, vkQueueSubmit);
    FIND(get_fence_status, vkGetFenceStatus);
    FIND(wait_idle, vkDeviceWaitIdle);
    FIND(allocate_memory, vkAllocateMemory);
    FIND(create_pipelines, vkCreateComputePipelines);
    FIND(dispatch, vkCmdDispatch);
#undef FIND
    return VK_SUCCESS;
}

static PFN_vkVoidFunction own_function(const char *name);

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char *name)
{
    PFN_vkVoidFunction own = own_function(name);
    return own ? own : next_device_function(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char *name)
{
    PFN_vkVoidFunction own = own_function(name);
    return own ? own : next_instance_function(instance, name);
}

static PFN_vkVoidFunction own_function(const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } functions[] = {
        {"vkGetInstanceProcAddr", (PFN_vkVoidFunction)get_instance_function},
        {"vkGetDeviceProcAddr", (PFN_vkVoidFunction)get_device_function},
        {"vkCreateInstance", (PFN_vkVoidFunction)create_instance},
        {"vkCreateDevice", (PFN_vkVoidFunction)create_device},
        {"vkGetPhysicalDeviceProperties", (PFN_vkVoidFunction)get_properties},
        {"vkGetPhysicalDeviceProperties2", (PFN_vkVoidFunction)get_properties_2},
        {"vkGetPhysicalDeviceMemoryProperties", (PFN_vkVoidFunction)get_memory},
        {"vkQueueSubmit", (PFN_vkVoidFunction)queue_submit},
        {"vkGetFenceStatus", (PFN_vkVoidFunction)get_fence_status},
        {"vkAllocateMemory", (PFN_vkVoidFunction)allocate_memory},
        {"vkCreateComputePipelines", (PFN_vkVoidFunction)create_pipelines},
        {"vkCmdDispatch", (PFN_vkVoidFunction)dispatch},
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; ++i)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].function;
    return NULL;
}

VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version);
VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version)
{
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = get_instance_function;
    version->pfnGetDeviceProcAddr = get_device_function;
    version->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
