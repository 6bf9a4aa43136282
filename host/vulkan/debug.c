#include "vulkan/debug.h"

#include <stdlib.h>
#include <string.h>

bool vulkan_debug_available(void)
{
    bool found = false;
    uint32_t count = 0;
    VkExtensionProperties *extensions = NULL;
    if (vkEnumerateInstanceExtensionProperties(NULL, &count, NULL) == VK_SUCCESS &&
        (extensions = calloc(count + 1, sizeof *extensions)) != NULL &&
        vkEnumerateInstanceExtensionProperties(NULL, &count, extensions) == VK_SUCCESS)
        for (uint32_t i = 0; i < count; ++i)
            found = found || strcmp(extensions[i].extensionName, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
    free(extensions);
    return found;
}

void vulkan_debug_load(struct vulkan_context *context)
{
    const VkInstance instance = context->instance;
    context->set_object_name =
        (PFN_vkSetDebugUtilsObjectNameEXT)vkGetInstanceProcAddr(instance, "vkSetDebugUtilsObjectNameEXT");
    context->begin_label =
        (PFN_vkCmdBeginDebugUtilsLabelEXT)vkGetInstanceProcAddr(instance, "vkCmdBeginDebugUtilsLabelEXT");
    context->end_label =
        (PFN_vkCmdEndDebugUtilsLabelEXT)vkGetInstanceProcAddr(instance, "vkCmdEndDebugUtilsLabelEXT");
}

void vulkan_name(struct vulkan_context *context, VkObjectType type, uint64_t handle, const char *name)
{
    if (context->set_object_name && handle)
        context->set_object_name(context->device,
                                 &(VkDebugUtilsObjectNameInfoEXT){
                                     .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                     .objectType = type,
                                     .objectHandle = handle,
                                     .pObjectName = name,
                                 });
}

void vulkan_label_begin(struct vulkan_context *context, VkCommandBuffer commands, const char *name)
{
    if (context->begin_label)
        context->begin_label(commands, &(VkDebugUtilsLabelEXT){
                                           .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                           .pLabelName = name,
                                       });
}

void vulkan_label_end(struct vulkan_context *context, VkCommandBuffer commands)
{
    if (context->end_label)
        context->end_label(commands);
}
