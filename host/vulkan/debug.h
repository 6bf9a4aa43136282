#ifndef VKWHITTED_VULKAN_DEBUG_H
#define VKWHITTED_VULKAN_DEBUG_H

#include "vulkan/context.h"

/* Names of objects and labels in command buffers, for debuggers as RenderDoc. They do nothing where the
 * extension VK_EXT_debug_utils is missing. */

/* Whether instances can have the extension. */
bool vulkan_debug_available(void);

/* Finds the extension's functions, once there is an instance that has it. */
void vulkan_debug_load(struct vulkan_context *context);

void vulkan_name(struct vulkan_context *context, VkObjectType type, uint64_t handle, const char *name);
void vulkan_label_begin(struct vulkan_context *context, VkCommandBuffer commands, const char *name);
void vulkan_label_end(struct vulkan_context *context, VkCommandBuffer commands);

#endif
