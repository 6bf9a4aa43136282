#include "vulkan/context.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/number.h"
#include "vulkan/debug.h"

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

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

static bool has_validation_layer(void)
{
    bool found = false;
    uint32_t count = 0;
    VkLayerProperties *layers = NULL;
    if (vkEnumerateInstanceLayerProperties(&count, NULL) == VK_SUCCESS &&
        (layers = calloc(count + 1, sizeof *layers)) != NULL &&
        vkEnumerateInstanceLayerProperties(&count, layers) == VK_SUCCESS)
        for (uint32_t i = 0; i < count; ++i)
            found = found || strcmp(layers[i].layerName, validation_layer) == 0;
    free(layers);
    return found;
}

static enum status create_instance(struct vulkan_context *context, const struct vulkan_options *options)
{
    const bool validate = options->validate;
    const char *extensions[8];
    uint32_t extension_count = options->instance_extension_count;
    if (extension_count >= sizeof extensions / sizeof *extensions) {
        log_error("the window system needs %u Vulkan extensions, room for %zu", extension_count,
                  sizeof extensions / sizeof *extensions - 1);
        return STATUS_UNABLE;
    }
    for (uint32_t i = 0; i < extension_count; ++i)
        extensions[i] = options->instance_extensions[i];
    if (validate || vulkan_debug_available())
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validate && !has_validation_layer()) {
        log_error("--validate needs the layer %s (Debian: vulkan-validationlayers)", validation_layer);
        return STATUS_UNABLE;
    }
    const VkDebugUtilsMessengerCreateInfoEXT messenger_info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = report_message,
        .pUserData = context,
    };
    VULKAN_CALL(vkCreateInstance,
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
    vulkan_debug_load(context);
    if (validate) {
        PFN_vkCreateDebugUtilsMessengerEXT create = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            context->instance, "vkCreateDebugUtilsMessengerEXT");
        VULKAN_CALL(create, context->instance, &messenger_info, NULL, &context->messenger);
    }
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* The devices of the instance, to be freed by the caller; NULL (reported) if there are none. */
static VkPhysicalDevice *list_devices(VkInstance instance, uint32_t *count)
{
    VkPhysicalDevice *devices = NULL;
    *count = 0;
    VULKAN_CALL(vkEnumeratePhysicalDevices, instance, count, NULL);
    devices = calloc(*count + 1, sizeof *devices);
    if (!devices || *count == 0) {
        log_error("no Vulkan device found; Debian's mesa-vulkan-drivers has one that needs no graphics card");
        goto error;
    }
    VULKAN_CALL(vkEnumeratePhysicalDevices, instance, count, devices);
    return devices;

error:
    free(devices);
    return NULL;
}

static bool find_compute_queue(const struct vulkan_context *context, VkPhysicalDevice device,
                               uint32_t *family, uint32_t *timestamp_bits)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = sizeof families / sizeof *families;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    for (uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) &&
            (!context->can_present || context->can_present(context->instance, device, i))) {
            *family = i;
            *timestamp_bits = families[i].timestampValidBits;
            return true;
        }
    }
    return false;
}

/* Higher is better; 0: cannot be used. */
static int score_device(const struct vulkan_context *context, VkPhysicalDevice device,
                        const VkPhysicalDeviceProperties *properties)
{
    uint32_t family, bits;
    if (properties->apiVersion < VK_API_VERSION_1_2 || !find_compute_queue(context, device, &family, &bits))
        return 0;
    switch (properties->deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 5;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 2;
    default:
        return 1;
    }
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

/* The number of the best device that matches the choice, or count (reported). */
static uint32_t choose_device(const struct vulkan_context *context, const char *choice,
                              const VkPhysicalDevice *devices, uint32_t count)
{
    const char *needed = context->can_present ? " that can show pictures in a window" : "";
    uint32_t chosen = count;
    int best_score = 0;
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        int score = score_device(context, devices[i], &properties);
        if (score > best_score && device_matches(choice, i, properties.deviceName)) {
            chosen = i;
            best_score = score;
        }
    }
    if (chosen == count && choice)
        log_error("--device %s: no usable device of this number or name%s; 'vkwhitted devices' lists them",
                  choice, needed);
    else if (chosen == count)
        log_error(
            "no device offers Vulkan 1.2 and a compute queue%s; 'vkwhitted devices' lists what is there",
            needed);
    return chosen;
}

static enum status open_device(struct vulkan_context *context, const char *choice)
{
    uint32_t count;
    VkPhysicalDevice *devices = list_devices(context->instance, &count);
    if (!devices)
        return STATUS_UNABLE;
    uint32_t chosen = choose_device(context, choice, devices, count);
    context->physical_device = chosen < count ? devices[chosen] : VK_NULL_HANDLE;
    free(devices);
    if (!context->physical_device)
        return choice ? STATUS_REFUSED : STATUS_UNABLE;

    context->driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
        .pNext = &context->driver,
    };
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &subgroup,
    };
    vkGetPhysicalDeviceProperties2(context->physical_device, &properties);
    if (!(subgroup.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT)) {
        log_error("%s has no arithmetic over subgroups, which the shader needs",
                  properties.properties.deviceName);
        return STATUS_UNABLE;
    }
    context->properties = properties.properties;
    context->driver.pNext = NULL;
    vkGetPhysicalDeviceMemoryProperties(context->physical_device, &context->memory);
    find_compute_queue(context, context->physical_device, &context->queue_family, &context->timestamp_bits);
    VkPhysicalDeviceFeatures available;
    vkGetPhysicalDeviceFeatures(context->physical_device, &available);
    context->has_float64 = available.shaderFloat64;
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
                    .enabledExtensionCount = context->can_present ? 1 : 0,
                    .ppEnabledExtensionNames = (const char *[]){VK_KHR_SWAPCHAIN_EXTENSION_NAME},
                    .pEnabledFeatures = &(VkPhysicalDeviceFeatures){.shaderFloat64 = available.shaderFloat64},
                },
                NULL, &context->device);
    vkGetDeviceQueue(context->device, context->queue_family, 0, &context->queue);
    log_info("device: %s (%s %s)", context->properties.deviceName, context->driver.driverName,
             context->driver.driverInfo);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status vulkan_context_create(const struct vulkan_options *options, struct vulkan_context **context)
{
    *context = calloc(1, sizeof **context);
    if (!*context) {
        log_error("no memory for the Vulkan context");
        return STATUS_UNABLE;
    }
    (*context)->can_present = options->can_present;
    enum status status = create_instance(*context, options);
    if (status == STATUS_DONE)
        status = open_device(*context, options->device);
    if (status != STATUS_DONE)
        vulkan_context_destroy(context);
    return status;
}

enum status vulkan_context_destroy(struct vulkan_context **pointer)
{
    struct vulkan_context *context = *pointer;
    *pointer = NULL;
    if (!context)
        return STATUS_DONE;
    if (context->device)
        vkDestroyDevice(context->device, NULL);
    if (context->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(context->instance,
                                                                       "vkDestroyDebugUtilsMessengerEXT");
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

static const char *type_name(VkPhysicalDeviceType type)
{
    static const char *const names[] = {"other", "integrated GPU", "discrete GPU", "virtual GPU", "CPU"};
    return (size_t)type < sizeof names / sizeof *names ? names[type] : "unknown";
}

/* Returns whether it can be used. */
static bool print_device(const struct vulkan_context *context, VkPhysicalDevice device, uint32_t index,
                         bool chosen)
{
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties2 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &driver,
    };
    vkGetPhysicalDeviceProperties2(device, &properties2);
    const VkPhysicalDeviceProperties *properties = &properties2.properties;
    const VkPhysicalDeviceLimits *limits = &properties->limits;
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(device, &features);
    printf("%c %" PRIu32 "  %s\n", chosen ? '*' : ' ', index, properties->deviceName);
    bool usable = score_device(context, device, properties) > 0;
    printf("      type            %s\n", type_name(properties->deviceType));
    printf("      driver          %s %s\n", driver.driverName, driver.driverInfo);
    printf("      Vulkan          %u.%u.%u%s\n", VK_API_VERSION_MAJOR(properties->apiVersion),
           VK_API_VERSION_MINOR(properties->apiVersion), VK_API_VERSION_PATCH(properties->apiVersion),
           usable ? "" : " (cannot be used: Vulkan 1.2 and a compute queue are needed)");
    printf("      fp64            %s\n", features.shaderFloat64 ? "yes" : "no");
    printf("      storage buffer  %" PRIu32 " bytes\n", limits->maxStorageBufferRange);
    printf("      uniform buffer  %" PRIu32 " bytes\n", limits->maxUniformBufferRange);
    printf("      group           %" PRIu32 " x %" PRIu32 " x %" PRIu32 ", %" PRIu32 " invocations\n",
           limits->maxComputeWorkGroupSize[0], limits->maxComputeWorkGroupSize[1],
           limits->maxComputeWorkGroupSize[2], limits->maxComputeWorkGroupInvocations);
    return usable;
}

/* Opens the device for it. */
static enum status print_opened(const struct vulkan_options *options, uint32_t index,
                                enum status (*print_more)(struct vulkan_context *))
{
    char choice[16];
    struct vulkan_context *context;
    snprintf(choice, sizeof choice, "%" PRIu32, index);
    enum status status = vulkan_context_create(
        &(struct vulkan_options){.device = choice, .validate = options->validate}, &context);
    if (status != STATUS_DONE)
        return status;
    status = print_more(context);
    enum status closed = vulkan_context_destroy(&context);
    return status == STATUS_DONE ? closed : status;
}

enum status vulkan_print_devices(const struct vulkan_options *options,
                                 enum status (*print_more)(struct vulkan_context *))
{
    struct vulkan_context *context = calloc(1, sizeof *context);
    if (!context) {
        log_error("no memory for the Vulkan context");
        return STATUS_UNABLE;
    }
    enum status status = create_instance(context, options);
    uint32_t count = 0;
    VkPhysicalDevice *devices = status == STATUS_DONE ? list_devices(context->instance, &count) : NULL;
    if (devices) {
        uint32_t chosen = choose_device(context, options->device, devices, count);
        for (uint32_t i = 0; i < count && status == STATUS_DONE; ++i)
            if (print_device(context, devices[i], i, i == chosen))
                status = print_opened(options, i, print_more);
        if (chosen == count)
            status = options->device ? STATUS_REFUSED : STATUS_UNABLE;
    } else {
        status = STATUS_UNABLE;
    }
    free(devices);
    enum status closed = vulkan_context_destroy(&context);
    return status == STATUS_DONE ? closed : status;
}
