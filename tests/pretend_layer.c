/* A Vulkan layer that makes a device look like another, and fail.
 * Under faults/fail_calls.c the calls with a result are calls that fail: out of memory, or the device is
 * lost.
 *
 * PRETEND_GPU=1: a discrete graphics card: no memory that the host caches, 64 KiB of uniforms, 128 bytes of
 * push constants, subgroups of 1 without operations, another driver.
 *
 * PRETEND_TEXELS=N: texel buffers have at most so many elements.
 *
 * PRETEND_FAIL=FILE: while there is such a file, with "N CODE" in it, calls with a result are counted; the
 * N-th returns CODE instead, and the file is removed.
 *
 * PRETEND_LOG=FILE: gets a line "X Y" for each dispatch: its groups. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

/* What is below the layer, of one instance with one device at a time. The loader tells it while they are
 * made; later it would tell the layer's own functions. */
static VkInstance the_instance;
static VkDevice the_device;
static PFN_vkGetInstanceProcAddr next_instance_function;
static PFN_vkGetDeviceProcAddr next_device_function;
static struct {
    PFN_vkGetPhysicalDeviceProperties get_properties;
    PFN_vkGetPhysicalDeviceProperties2 get_properties_2;
    PFN_vkGetPhysicalDeviceMemoryProperties get_memory;
    PFN_vkDeviceWaitIdle wait_idle;
    PFN_vkCmdDispatch dispatch;
} next;

/* Of faults/fail_calls.c, where that is loaded. */
bool fails_in_vulkan(void) __attribute__((weak));

/* What this call is to return; VK_SUCCESS: what the driver says. */
static VkResult planned_failure(bool may_lose_device)
{
    static int calls;
    int turn = 0, code = VK_SUCCESS;
    if (fails_in_vulkan && fails_in_vulkan())
        return may_lose_device ? VK_ERROR_DEVICE_LOST : VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const char *path = getenv("PRETEND_FAIL");
    FILE *plan = path ? fopen(path, "r") : NULL;
    if (!plan) {
        calls = 0;
        return VK_SUCCESS;
    }
    if (fscanf(plan, "%d %d", &turn, &code) != 2 || ++calls != turn)
        code = VK_SUCCESS;
    fclose(plan);
    if (code != VK_SUCCESS)
        unlink(path);
    return (VkResult)code;
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

/* The functions with a result that the program calls: X(name, may lose the device). Their arguments are
 * handles, pointers and integers, which 64-bit processors pass on as words whatever they mean. */
#define FUNCTIONS(X)                                                                                         \
    X(vkEnumeratePhysicalDevices, false)                                                                     \
    X(vkAllocateCommandBuffers, false)                                                                       \
    X(vkAllocateDescriptorSets, false)                                                                       \
    X(vkAllocateMemory, false)                                                                               \
    X(vkBeginCommandBuffer, false)                                                                           \
    X(vkBindBufferMemory, false)                                                                             \
    X(vkCreateBuffer, false)                                                                                 \
    X(vkCreateBufferView, false)                                                                             \
    X(vkCreateCommandPool, false)                                                                            \
    X(vkCreateComputePipelines, false)                                                                       \
    X(vkCreateDescriptorPool, false)                                                                         \
    X(vkCreateDescriptorSetLayout, false)                                                                    \
    X(vkCreateFence, false)                                                                                  \
    X(vkCreatePipelineLayout, false)                                                                         \
    X(vkCreateQueryPool, false)                                                                              \
    X(vkCreateShaderModule, false)                                                                           \
    X(vkEndCommandBuffer, false)                                                                             \
    X(vkGetFenceStatus, true)                                                                                \
    X(vkGetQueryPoolResults, true)                                                                           \
    X(vkMapMemory, false)                                                                                    \
    X(vkQueueSubmit, true)                                                                                   \
    X(vkResetFences, false)

typedef uintptr_t word;
typedef VkResult (*function_of_words)(word, word, word, word, word, word, word, word);
/* What may lose the device is done, and the device at rest, before it fails. That a fence is not ready is no
 * call. */
#define DEFINE(name, may_lose_device)                                                                        \
    static PFN_vkVoidFunction next_##name;                                                                   \
    static VKAPI_ATTR VkResult VKAPI_CALL pretended_##name(word a, word b, word c, word d, word e, word f,   \
                                                           word g, word h)                                   \
    {                                                                                                        \
        const function_of_words function = (function_of_words)next_##name;                                   \
        const VkResult result = may_lose_device ? function(a, b, c, d, e, f, g, h) : VK_SUCCESS;             \
        const VkResult failure = result == VK_SUCCESS ? planned_failure(may_lose_device) : result;           \
        if (failure != VK_SUCCESS && failure != VK_NOT_READY && the_device)                                  \
            next.wait_idle(the_device);                                                                      \
        return may_lose_device || failure != VK_SUCCESS ? failure : function(a, b, c, d, e, f, g, h);        \
    }
FUNCTIONS(DEFINE)

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
    VkResult result = planned_failure(false);
    if (result == VK_SUCCESS)
        result = create(info, allocator, instance);
    if (result != VK_SUCCESS)
        return result;
#define FIND(member, name) next.member = (PFN_##name)next_instance_function(*instance, #name)
    the_instance = *instance;
    FIND(get_properties, vkGetPhysicalDeviceProperties);
    FIND(get_properties_2, vkGetPhysicalDeviceProperties2);
    FIND(get_memory, vkGetPhysicalDeviceMemoryProperties);
#undef FIND
    next_vkEnumeratePhysicalDevices = next_instance_function(*instance, "vkEnumeratePhysicalDevices");
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
    VkResult result = planned_failure(false);
    if (result == VK_SUCCESS)
        result = create(physical_device, info, allocator, device);
    if (result != VK_SUCCESS)
        return result;
#define FIND(member, name) next.member = (PFN_##name)next_device_function(*device, #name)
    the_device = *device;
    FIND(wait_idle, vkDeviceWaitIdle);
    FIND(dispatch, vkCmdDispatch);
#undef FIND
#define FIND(name, may_lose_device)                                                                          \
    if (strcmp(#name, "vkEnumeratePhysicalDevices") != 0 && next_device_function(*device, #name))            \
        next_##name = next_device_function(*device, #name);
    FUNCTIONS(FIND)
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
    } functions[] = {{"vkGetInstanceProcAddr", (PFN_vkVoidFunction)get_instance_function},
                     {"vkGetDeviceProcAddr", (PFN_vkVoidFunction)get_device_function},
                     {"vkCreateInstance", (PFN_vkVoidFunction)create_instance},
                     {"vkCreateDevice", (PFN_vkVoidFunction)create_device},
                     {"vkGetPhysicalDeviceProperties", (PFN_vkVoidFunction)get_properties},
                     {"vkGetPhysicalDeviceProperties2", (PFN_vkVoidFunction)get_properties_2},
                     {"vkGetPhysicalDeviceMemoryProperties", (PFN_vkVoidFunction)get_memory},
                     {"vkCmdDispatch", (PFN_vkVoidFunction)dispatch},
#define NAMED(name, may_lose_device) {#name, (PFN_vkVoidFunction)pretended_##name},
                     FUNCTIONS(NAMED)
#undef NAMED
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; ++i)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].function;
    return NULL;
}

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version);
VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version)
{
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = get_instance_function;
    version->pfnGetDeviceProcAddr = get_device_function;
    version->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
