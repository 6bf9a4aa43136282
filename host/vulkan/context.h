#ifndef VKWHITTED_VULKAN_CONTEXT_H
#define VKWHITTED_VULKAN_CONTEXT_H

#include <stdatomic.h>
#include <vulkan/vulkan.h>

#include "base/status.h"

enum denormals { DENORMALS_KEPT, DENORMALS_FLUSHED, DENORMALS_MIXED };
enum fused { FUSED_ALWAYS, FUSED_NEVER, FUSED_MIXED };

/* What single-precision arithmetic on a device was found to do with normal numbers; see probe.h. */
struct arithmetic {
    bool known;          /* probed */
    bool basics_exact;   /* + - * are correctly rounded, and `precise` keeps them from being contracted */
    bool division_exact; /* so is / */
    bool root_exact;     /* so is sqrt */
    enum denormals denormals; /* as results */
    enum fused fma;
    char flaw[160]; /* where the basics are not exact: an example */
};

/* An instance and one device with a compute queue, which may also present. */
struct vulkan_context {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceDriverProperties driver;
    VkPhysicalDeviceMemoryProperties memory;
    bool has_float64; /* enabled */
    bool has_subgroup_arithmetic;
    VkDevice device;
    uint32_t queue_family;   /* UINT32_MAX: the device has none that suits */
    uint32_t timestamp_bits; /* 0: the queue has no timestamps */
    VkQueue queue;
    struct arithmetic arithmetic; /* not known before probe_arithmetic() */
    atomic_uint validation_messages;

    /* Of VK_EXT_debug_utils. */
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;
};

struct vulkan_options {
    const char *device; /* number or part of the name of a device; NULL: the best one */
    bool validate;      /* Khronos validation layer, core and synchronisation checks */

    /* What a window system needs to show pictures: extensions of the instance, and whether a queue family can
     * present; NULL: nothing is shown, and there are no swapchains. */
    const char *const *instance_extensions;
    uint32_t instance_extension_count;
    int (*can_present)(VkInstance, VkPhysicalDevice, uint32_t family);
};

/* Opens a device. On failure *context is NULL and the reason is reported: STATUS_REFUSED for a device that
 * does not exist, STATUS_UNABLE for a machine without Vulkan or, with validate, without the layer. */
enum status vulkan_context_create(const struct vulkan_options *options, struct vulkan_context **context);

/* Destroys and sets *context to NULL. Returns STATUS_UNABLE if the validation layer has had anything to say,
 * each message having been reported, and STATUS_DONE otherwise. */
enum status vulkan_context_destroy(struct vulkan_context **context);

/* Prints the devices, their drivers and the limits that matter to standard output, with a * at the one that
 * these options choose. Each that can be used is opened for print_more(). */
enum status vulkan_print_devices(const struct vulkan_options *options,
                                 enum status (*print_more)(struct vulkan_context *));

/* Names an object for debuggers such as RenderDoc; a null handle is left alone. */
void vulkan_name(struct vulkan_context *context, VkObjectType type, uint64_t handle, const char *name);

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
