#ifndef VKWHITTED_VULKAN_RESULT_H
#define VKWHITTED_VULKAN_RESULT_H

#include <vulkan/vulkan.h>

#include "base/status.h"

/* A VkResult's name. */
const char *vulkan_result_name(VkResult result);

/* Reports a failed call by its name and jumps to the function's error label. */
#define VULKAN_CALL(function, ...)                                                                           \
    do {                                                                                                     \
        VkResult vulkan_result_ = function(__VA_ARGS__);                                                     \
        if (vulkan_result_ != VK_SUCCESS) {                                                                  \
            log_error("%s: %s", #function, vulkan_result_name(vulkan_result_));                              \
            goto error;                                                                                      \
        }                                                                                                    \
    } while (0)

#endif
