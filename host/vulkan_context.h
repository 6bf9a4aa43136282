#ifndef VKWHITTED_VULKAN_CONTEXT_H
#define VKWHITTED_VULKAN_CONTEXT_H

#include <stdatomic.h>
#include <vulkan/vulkan.h>

#include "arithmetic.h"
#include "status.h"

/* An instance and one device with a compute queue. */
struct vulkan_context {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceDriverProperties driver;
    VkPhysicalDeviceMemoryProperties memory;
    VkDevice device;
    uint32_t queue_family;
    bool has_float64;        /* enabled */
    uint32_t timestamp_bits; /* 0: the queue has no timestamps */
    VkQueue queue;
    struct arithmetic arithmetic; /* not known before probe_arithmetic() */
    atomic_uint validation_messages;
};

struct vulkan_options {
    const char *device; /* number or part of the name of a device; NULL: the best one */
    bool validate;      /* Khronos validation layer, core and synchronisation checks */
};

/* Opens a device. On failure *context is NULL and the reason is reported: STATUS_REFUSED for a device that
 * does not exist, STATUS_UNABLE for a machine without Vulkan or, with validate, without the layer. */
enum status vulkan_context_create(const struct vulkan_options *options, struct vulkan_context **context);

/* Destroys and sets *context to NULL. Returns STATUS_UNABLE if the validation layer has had anything to say,
 * each message having been reported, and STATUS_DONE otherwise. */
enum status vulkan_context_destroy(struct vulkan_context **context);

/* Prints the devices, their drivers and the limits that matter to standard output, with a * at the one that
 * these options choose. */
enum status vulkan_print_devices(const struct vulkan_options *options);

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
