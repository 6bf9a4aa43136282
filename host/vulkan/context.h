#ifndef VKWHITTED_VULKAN_CONTEXT_H
#define VKWHITTED_VULKAN_CONTEXT_H

#include <stdatomic.h>
#include <vulkan/vulkan.h>

#include "base/status.h"

/* What single-precision arithmetic on a device was found to do with normal numbers; see probe.h. */
struct arithmetic {
    bool known;          /* probed */
    bool basics_exact;   /* + - * are correctly rounded, and `precise` keeps them from being contracted */
    bool division_exact; /* so is / */
    bool root_exact;     /* so is sqrt */
    char flaw[160];      /* where the basics are not exact: an example */
};

/* Whether the device's own division or square root will not do for exact pictures. */
static inline bool needs_correction(const struct arithmetic *arithmetic)
{
    return !arithmetic->division_exact || !arithmetic->root_exact;
}

enum { VULKAN_MOST_DEVICES = 64 };

/* An instance and one device with a compute queue. */
struct vulkan_context {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice devices[VULKAN_MOST_DEVICES]; /* of the machine */
    uint32_t device_count, chosen_device;
    VkPhysicalDevice physical_device; /* the one that the following is of */
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceDriverProperties driver;
    VkPhysicalDeviceMemoryProperties memory;
    VkPhysicalDeviceFloatControlsProperties float_controls;
    bool has_float64;       /* enabled */
    uint32_t subgroup_size; /* invocations that run side by side */
    VkDevice device;
    uint32_t queue_family;   /* UINT32_MAX: the device has none that suits */
    uint32_t timestamp_bits; /* 0: the queue has no timestamps */
    VkQueue queue;
    bool lost;                    /* the device is: all that is left is to destroy */
    bool hung;                    /* it may still be at work, so that nothing that it uses is destroyed */
    struct arithmetic arithmetic; /* not known before probe_arithmetic() */
    atomic_uint validation_messages;
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name;
    PFN_vkCmdInsertDebugUtilsLabelEXT insert_label;
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
 * these options choose. Each that can be used is opened for print_more(). */
enum status vulkan_print_devices(const struct vulkan_options *options,
                                 enum status (*print_more)(struct vulkan_context *));

/* Names an object for debuggers such as RenderDoc; a null handle is left alone. */
void vulkan_name(struct vulkan_context *context, VkObjectType type, uint64_t handle, const char *name);

/* Ends a frame for debuggers that capture one: the program presents nothing, and RenderDoc and GFXReconstruct
 * take this label for it. */
void vulkan_end_frame(struct vulkan_context *context, VkCommandBuffer commands);

/* Reports a failed call; a lost device is noted. */
void vulkan_report(struct vulkan_context *context, const char *call, VkResult result);

/* Reports a failed call by its name and jumps to the function's error label. */
#define VULKAN_CALL(context, function, ...)                                                                  \
    do {                                                                                                     \
        VkResult vulkan_result_ = function(__VA_ARGS__);                                                     \
        if (vulkan_result_ != VK_SUCCESS) {                                                                  \
            vulkan_report(context, #function, vulkan_result_);                                               \
            goto error;                                                                                      \
        }                                                                                                    \
    } while (0)

#endif
