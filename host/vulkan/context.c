#include "vulkan/context.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/number.h"

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

const char *vulkan_result_name(VkResult result)
{
#define NAME(name)                                                                                           \
    case name:                                                                                               \
        return #name
    switch (result) {
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY);
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY);
        NAME(VK_ERROR_INITIALIZATION_FAILED);
        NAME(VK_ERROR_DEVICE_LOST);
        NAME(VK_ERROR_MEMORY_MAP_FAILED);
        NAME(VK_ERROR_LAYER_NOT_PRESENT);
        NAME(VK_ERROR_EXTENSION_NOT_PRESENT);
        NAME(VK_ERROR_FEATURE_NOT_PRESENT);
        NAME(VK_ERROR_INCOMPATIBLE_DRIVER);
        NAME(VK_ERROR_TOO_MANY_OBJECTS);
        NAME(VK_INCOMPLETE);
        NAME(VK_NOT_READY);
        NAME(VK_TIMEOUT);
        NAME(VK_SUBOPTIMAL_KHR);
        NAME(VK_ERROR_OUT_OF_DATE_KHR);
        NAME(VK_ERROR_SURFACE_LOST_KHR);
        NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
    default:
        return "VkResult not known to vkwhitted";
    }
#undef NAME
}

void vulkan_name(struct vulkan_context *context, VkObjectType type, uint64_t handle, const char *name)
{
    if (handle)
        context->set_object_name(context->device,
                                 &(VkDebugUtilsObjectNameInfoEXT){
                                     .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                     .objectType = type,
                                     .objectHandle = handle,
                                     .pObjectName = name,
                                 });
}

static VKAPI_ATTR VkBool32 VKAPI_CALL report_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                     VkDebugUtilsMessageTypeFlagsEXT types,
                                                     const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                     void *user)
{
    struct vulkan_context *context = user;
    (void)types;
    (void)severity;
    atomic_fetch_add(&context->validation_messages, 1);
    log_error("Vulkan validation: %s", data->pMessage);
    return VK_FALSE;
}

static void report_no_device(void)
{
    log_error("no Vulkan device found; Debian's mesa-vulkan-drivers has one that needs no graphics card");
}

/* The function of the instance, which has VK_EXT_debug_utils. */
#define FIND(context, name) (PFN_##name)(void (*)(void)) vkGetInstanceProcAddr((context)->instance, #name)

static enum status create_instance(struct vulkan_context *context, const struct vulkan_options *options)
{
    const bool validate = options->validate;
    const char *extensions[8] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME}; /* which the loader always has */
    uint32_t extension_count = 1;
    if (options->instance_extension_count >= sizeof extensions / sizeof *extensions) {
        log_error("the window system needs %u Vulkan extensions, room for %zu",
                  options->instance_extension_count, sizeof extensions / sizeof *extensions - 1);
        return STATUS_UNABLE;
    }
    for (uint32_t i = 0; i < options->instance_extension_count; ++i)
        extensions[extension_count++] = options->instance_extensions[i];
    const VkDebugUtilsMessengerCreateInfoEXT messenger_info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = report_message,
        .pUserData = context,
    };
    VkResult result = vkCreateInstance(
        &(VkInstanceCreateInfo){
            .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
            .pNext = validate ? &(VkValidationFeaturesEXT){
                .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                .pNext = &messenger_info,
                .enabledValidationFeatureCount = 1,
                .pEnabledValidationFeatures =
                    &(VkValidationFeatureEnableEXT){VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT},
            } : NULL,
            .pApplicationInfo =
                &(VkApplicationInfo){
                    .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                    .pApplicationName = "vkwhitted",
                    .apiVersion = VK_API_VERSION_1_2,
                },
            .enabledLayerCount = validate ? 1 : 0,
            .ppEnabledLayerNames = (const char *[]){validation_layer},
            .enabledExtensionCount = extension_count,
            .ppEnabledExtensionNames = extensions,
        },
        NULL, &context->instance);
    if (result == VK_ERROR_LAYER_NOT_PRESENT)
        log_error("--validate needs the layer %s (Debian: vulkan-validationlayers)", validation_layer);
    else if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        report_no_device();
    else if (result != VK_SUCCESS)
        log_error("vkCreateInstance: %s", vulkan_result_name(result));
    if (result != VK_SUCCESS)
        return STATUS_UNABLE;
    context->set_object_name = FIND(context, vkSetDebugUtilsObjectNameEXT);
    context->begin_label = FIND(context, vkCmdBeginDebugUtilsLabelEXT);
    context->end_label = FIND(context, vkCmdEndDebugUtilsLabelEXT);
    PFN_vkCreateDebugUtilsMessengerEXT create_messenger = FIND(context, vkCreateDebugUtilsMessengerEXT);
    if (validate)
        VULKAN_CALL(create_messenger, context->instance, &messenger_info, NULL, &context->messenger);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* Learns what the device is and has. Higher is better; 0: it cannot be used. */
static int inspect_device(struct vulkan_context *context, const struct vulkan_options *options,
                          VkPhysicalDevice device)
{
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
        .pNext = &context->driver,
    };
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &subgroup,
    };
    context->physical_device = device;
    context->driver = (VkPhysicalDeviceDriverProperties){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
    };
    vkGetPhysicalDeviceProperties2(device, &properties);
    context->properties = properties.properties;
    context->has_subgroup_arithmetic = subgroup.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    vkGetPhysicalDeviceMemoryProperties(device, &context->memory);
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(device, &features);
    context->has_float64 = features.shaderFloat64;

    VkQueueFamilyProperties families[16];
    uint32_t count = sizeof families / sizeof *families;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    context->queue_family = UINT32_MAX;
    for (uint32_t i = count; i-- > 0;) {
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) &&
            (!options->can_present || options->can_present(context->instance, device, i))) {
            context->queue_family = i;
            context->timestamp_bits = families[i].timestampValidBits;
        }
    }
    if (context->properties.apiVersion < VK_API_VERSION_1_2 || context->queue_family == UINT32_MAX)
        return 0;
    static const int scores[] = {
        [VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU] = 5, [VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU] = 4,
        [VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU] = 3,  [VK_PHYSICAL_DEVICE_TYPE_CPU] = 2,
        [VK_PHYSICAL_DEVICE_TYPE_OTHER] = 1,
    };
    const size_t type = (size_t)context->properties.deviceType;
    return type < sizeof scores / sizeof *scores ? scores[type] : 1;
}

static bool device_matches(const char *choice, uint32_t index, const char *name)
{
    unsigned long number;
    if (!choice)
        return true;
    if (parse_unsigned(choice, strlen(choice), UINT32_MAX, &number))
        return number == index;
    return strcasestr(name, choice) != NULL;
}

/* The number of the best device that matches the options, or count (reported). */
static uint32_t choose_device(struct vulkan_context *context, const struct vulkan_options *options,
                              const VkPhysicalDevice *devices, uint32_t count)
{
    const char *needed = options->can_present ? " that can show pictures in a window" : "";
    uint32_t chosen = count;
    int best_score = 0;
    for (uint32_t i = 0; i < count; ++i) {
        int score = inspect_device(context, options, devices[i]);
        if (score > best_score && device_matches(options->device, i, context->properties.deviceName)) {
            chosen = i;
            best_score = score;
        }
    }
    if (chosen == count && options->device)
        log_error("--device %s: no usable device of this number or name%s; 'vkwhitted devices' lists them",
                  options->device, needed);
    else if (chosen == count)
        log_error(
            "no device offers Vulkan 1.2 and a compute queue%s; 'vkwhitted devices' lists what is there",
            needed);
    return chosen;
}

/* The machine's devices, and the number of the one that the options choose (count, reported: none). */
struct device_list {
    VkPhysicalDevice *devices; /* to be freed */
    uint32_t count, chosen;
};

/* Makes a context without an open device. On failure (reported) there is none. */
static enum status create_context(const struct vulkan_options *options, struct vulkan_context **pointer,
                                  struct device_list *list)
{
    struct vulkan_context *context = *pointer = calloc(1, sizeof *context);
    *list = (struct device_list){0};
    if (!context)
        log_error("no memory for the Vulkan context");
    if (!context || create_instance(context, options) != STATUS_DONE)
        goto error;
    VULKAN_CALL(vkEnumeratePhysicalDevices, context->instance, &list->count, NULL);
    list->devices = calloc(list->count + 1, sizeof *list->devices);
    if (!list->devices || list->count == 0) {
        report_no_device();
        goto error;
    }
    VULKAN_CALL(vkEnumeratePhysicalDevices, context->instance, &list->count, list->devices);
    list->chosen = choose_device(context, options, list->devices, list->count);
    return STATUS_DONE;

error:
    free(list->devices);
    vulkan_context_destroy(pointer);
    return STATUS_UNABLE;
}

/* Opens the device that was inspected last. */
static enum status open_device(struct vulkan_context *context, const struct vulkan_options *options)
{
    if (!context->has_subgroup_arithmetic) {
        log_error("%s has no arithmetic over subgroups, which the shader needs",
                  context->properties.deviceName);
        return STATUS_UNABLE;
    }
    VULKAN_CALL(vkCreateDevice, context->physical_device,
                &(VkDeviceCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                    .queueCreateInfoCount = 1,
                    .pQueueCreateInfos =
                        &(VkDeviceQueueCreateInfo){
                            .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                            .queueFamilyIndex = context->queue_family,
                            .queueCount = 1,
                            .pQueuePriorities = &(float){1},
                        },
                    .enabledExtensionCount = options->can_present ? 1 : 0,
                    .ppEnabledExtensionNames = (const char *[]){VK_KHR_SWAPCHAIN_EXTENSION_NAME},
                    .pEnabledFeatures = &(VkPhysicalDeviceFeatures){.shaderFloat64 = context->has_float64},
                },
                NULL, &context->device);
    vkGetDeviceQueue(context->device, context->queue_family, 0, &context->queue);
    log_info("device: %s (%s %s)", context->properties.deviceName, context->driver.driverName,
             context->driver.driverInfo);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_context_create(const struct vulkan_options *options, struct vulkan_context **pointer)
{
    struct device_list list;
    enum status status = create_context(options, pointer, &list);
    if (status != STATUS_DONE)
        return status;
    if (list.chosen < list.count) {
        inspect_device(*pointer, options, list.devices[list.chosen]);
        status = open_device(*pointer, options);
    } else {
        status = options->device ? STATUS_REFUSED : STATUS_UNABLE;
    }
    free(list.devices);
    if (status != STATUS_DONE)
        vulkan_context_destroy(pointer);
    return status;
}

static void close_device(struct vulkan_context *context)
{
    if (context->device)
        vkDestroyDevice(context->device, NULL);
    context->device = NULL;
    context->arithmetic = (struct arithmetic){0};
}

enum status vulkan_context_destroy(struct vulkan_context **pointer)
{
    struct vulkan_context *context = *pointer;
    *pointer = NULL;
    if (!context)
        return STATUS_DONE;
    close_device(context);
    if (context->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy = FIND(context, vkDestroyDebugUtilsMessengerEXT);
        destroy(context->instance, context->messenger, NULL);
    }
    if (context->instance)
        vkDestroyInstance(context->instance, NULL);
    unsigned messages = atomic_load(&context->validation_messages);
    free(context);
    if (messages > 0)
        log_error("%u validation message%s", messages, messages == 1 ? "" : "s");
    return messages > 0 ? STATUS_UNABLE : STATUS_DONE;
}

/* The device that was inspected last. */
static void print_device(const struct vulkan_context *context, uint32_t index, bool chosen, bool usable)
{
    static const char *const types[] = {"other", "integrated GPU", "discrete GPU", "virtual GPU", "CPU"};
    const VkPhysicalDeviceProperties *properties = &context->properties;
    const VkPhysicalDeviceLimits *limits = &properties->limits;
    printf("%c %" PRIu32 "  %s\n", chosen ? '*' : ' ', index, properties->deviceName);
    printf("      type            %s\n", (size_t)properties->deviceType < sizeof types / sizeof *types
                                             ? types[properties->deviceType]
                                             : "unknown");
    printf("      driver          %s %s\n", context->driver.driverName, context->driver.driverInfo);
    printf("      Vulkan          %u.%u.%u%s\n", VK_API_VERSION_MAJOR(properties->apiVersion),
           VK_API_VERSION_MINOR(properties->apiVersion), VK_API_VERSION_PATCH(properties->apiVersion),
           usable ? "" : " (cannot be used: Vulkan 1.2 and a compute queue are needed)");
    printf("      fp64            %s\n", context->has_float64 ? "yes" : "no");
    printf("      storage buffer  %" PRIu32 " bytes\n", limits->maxStorageBufferRange);
    printf("      uniform buffer  %" PRIu32 " bytes\n", limits->maxUniformBufferRange);
    printf("      group           %" PRIu32 " x %" PRIu32 " x %" PRIu32 ", %" PRIu32 " invocations\n",
           limits->maxComputeWorkGroupSize[0], limits->maxComputeWorkGroupSize[1],
           limits->maxComputeWorkGroupSize[2], limits->maxComputeWorkGroupInvocations);
}

enum status vulkan_print_devices(const struct vulkan_options *options,
                                 enum status (*print_more)(struct vulkan_context *))
{
    struct vulkan_context *context;
    struct device_list list;
    enum status status = create_context(options, &context, &list);
    for (uint32_t i = 0; i < list.count && status == STATUS_DONE; ++i) {
        bool usable = inspect_device(context, options, list.devices[i]) > 0;
        print_device(context, i, i == list.chosen, usable);
        if (usable)
            status = open_device(context, options);
        if (usable && status == STATUS_DONE)
            status = print_more(context);
        close_device(context);
    }
    if (status == STATUS_DONE && list.chosen == list.count)
        status = options->device ? STATUS_REFUSED : STATUS_UNABLE;
    free(list.devices);
    enum status closed = vulkan_context_destroy(&context);
    return status == STATUS_DONE ? closed : status;
}
