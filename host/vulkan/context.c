#include "vulkan/context.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/number.h"

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

#define NAMED(constant) constant, #constant

static const char *result_name(VkResult result)
{
    static const struct {
        VkResult result;
        const char *name;
    } names[] = {
        {NAMED(VK_ERROR_OUT_OF_HOST_MEMORY)},
        {NAMED(VK_ERROR_OUT_OF_DEVICE_MEMORY)},
        {NAMED(VK_ERROR_INITIALIZATION_FAILED)},
        {NAMED(VK_ERROR_DEVICE_LOST)},
        {NAMED(VK_ERROR_MEMORY_MAP_FAILED)},
        {NAMED(VK_ERROR_LAYER_NOT_PRESENT)},
        {NAMED(VK_ERROR_EXTENSION_NOT_PRESENT)},
        {NAMED(VK_ERROR_FEATURE_NOT_PRESENT)},
        {NAMED(VK_ERROR_INCOMPATIBLE_DRIVER)},
        {NAMED(VK_ERROR_TOO_MANY_OBJECTS)},
        {NAMED(VK_INCOMPLETE)},
        {NAMED(VK_NOT_READY)},
        {NAMED(VK_TIMEOUT)},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (names[i].result == result)
            return names[i].name;
    return "VkResult not known to vkwhitted";
}

void vulkan_report(struct vulkan_context *context, const char *call, VkResult result)
{
    context->lost = context->lost || result == VK_ERROR_DEVICE_LOST;
    log_error("%s: %s", call, result_name(result));
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

void vulkan_end_frame(struct vulkan_context *context, VkCommandBuffer commands)
{
    context->insert_label(commands, &(VkDebugUtilsLabelEXT){
                                        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                        .pLabelName = "vr-marker,frame_end,type,application",
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

/* Where the processor has vectors of 512 bits, asks Mesa's lavapipe for them: it takes 256 by itself, and
 * with 512 and groups as wide figure 4 takes 20.5 ms where it took 23.1, figure 2b 15.8 where it took 22.9
 * (1920x1080 and 600x400, two Zen 4 cores, Mesa 22.3). Other drivers do not look. */
static void ask_for_long_vectors(void)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512vl"))
        setenv("LP_NATIVE_VECTOR_WIDTH", "512", 0);
#endif
}

static enum status create_instance(struct vulkan_context *context, const struct vulkan_options *options)
{
    const bool validate = options->validate;
    const VkDebugUtilsMessengerCreateInfoEXT messenger_info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = report_message,
        .pUserData = context,
    };
    ask_for_long_vectors();
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
            .enabledExtensionCount = 1, /* which the loader always has */
            .ppEnabledExtensionNames = (const char *[]){VK_EXT_DEBUG_UTILS_EXTENSION_NAME},
        },
        NULL, &context->instance);
    if (result == VK_ERROR_LAYER_NOT_PRESENT)
        log_error("--validate needs the layer %s (Debian: vulkan-validationlayers)", validation_layer);
    else if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        report_no_device();
    else if (result != VK_SUCCESS)
        vulkan_report(context, "vkCreateInstance", result);
    if (result != VK_SUCCESS)
        return STATUS_UNABLE;
    context->set_object_name = FIND(context, vkSetDebugUtilsObjectNameEXT);
    context->insert_label = FIND(context, vkCmdInsertDebugUtilsLabelEXT);
    PFN_vkCreateDebugUtilsMessengerEXT create_messenger = FIND(context, vkCreateDebugUtilsMessengerEXT);
    if (validate)
        VULKAN_CALL(context, create_messenger, context->instance, &messenger_info, NULL, &context->messenger);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static const struct device_type {
    const char *name;
    int score; /* the best is chosen */
} device_types[] = {
    [VK_PHYSICAL_DEVICE_TYPE_OTHER] = {"other", 1},
    [VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU] = {"integrated GPU", 4},
    [VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU] = {"discrete GPU", 5},
    [VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU] = {"virtual GPU", 3},
    [VK_PHYSICAL_DEVICE_TYPE_CPU] = {"CPU", 2},
};

static struct device_type device_type(const struct vulkan_context *context)
{
    const size_t type = (size_t)context->properties.deviceType;
    return type < sizeof device_types / sizeof *device_types ? device_types[type]
                                                             : (struct device_type){"unknown", 1};
}

/* Learns what the device is and has. Returns whether it can be used. */
static bool inspect_device(struct vulkan_context *context, VkPhysicalDevice device)
{
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
        .pNext = &context->driver,
    };
    context->float_controls = (VkPhysicalDeviceFloatControlsProperties){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES,
        .pNext = &subgroup,
    };
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &context->float_controls,
    };
    context->physical_device = device;
    context->driver = (VkPhysicalDeviceDriverProperties){
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
    };
    vkGetPhysicalDeviceProperties2(device, &properties);
    context->properties = properties.properties;
    context->subgroup_size = subgroup.subgroupSize;
    vkGetPhysicalDeviceMemoryProperties(device, &context->memory);
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(device, &features);
    context->has_float64 = features.shaderFloat64;

    VkQueueFamilyProperties families[16];
    uint32_t count = sizeof families / sizeof *families;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    context->queue_family = UINT32_MAX;
    for (uint32_t i = count; i-- > 0;) {
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) {
            context->queue_family = i;
            context->timestamp_bits = families[i].timestampValidBits;
        }
    }
    return context->properties.apiVersion >= VK_API_VERSION_1_2 && context->queue_family != UINT32_MAX;
}

static bool device_matches(const char *choice, uint32_t index, const char *name)
{
    unsigned long number;
    if (choice && parse_unsigned(choice, strlen(choice), UINT32_MAX, &number))
        return number == index;
    return !choice || strcasestr(name, choice) != NULL;
}

/* Finds the best device that matches the options. On failure (reported) chosen_device is device_count. */
static enum status choose_device(struct vulkan_context *context, const struct vulkan_options *options)
{
    int best_score = 0;
    context->chosen_device = context->device_count;
    for (uint32_t i = 0; i < context->device_count; ++i)
        if (inspect_device(context, context->devices[i]) && device_type(context).score > best_score &&
            device_matches(options->device, i, context->properties.deviceName)) {
            context->chosen_device = i;
            best_score = device_type(context).score;
        }
    if (context->chosen_device < context->device_count)
        return STATUS_DONE;
    if (options->device)
        log_error("--device %s: no usable device of this number or name; 'vkwhitted devices' lists them",
                  options->device);
    else
        log_error("no device offers Vulkan 1.2 and a compute queue; 'vkwhitted devices' lists what is there");
    return options->device ? STATUS_REFUSED : STATUS_UNABLE;
}

/* Makes a context without an open device. On failure (reported) there is none. */
static enum status create_context(const struct vulkan_options *options, struct vulkan_context **pointer)
{
    struct vulkan_context *context = *pointer = calloc(1, sizeof *context);
    if (!context)
        log_error("no memory for the Vulkan context");
    if (!context || create_instance(context, options) != STATUS_DONE)
        goto error;
    context->device_count = VULKAN_MOST_DEVICES;
    VULKAN_CALL(context, vkEnumeratePhysicalDevices, context->instance, &context->device_count,
                context->devices);
    if (context->device_count > 0)
        return STATUS_DONE;
    report_no_device();

error:
    vulkan_context_destroy(pointer);
    return STATUS_UNABLE;
}

/* Opens the device that was inspected last. */
static enum status open_device(struct vulkan_context *context)
{
    VULKAN_CALL(context, vkCreateDevice, context->physical_device,
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
    enum status status = create_context(options, pointer);
    if (status != STATUS_DONE)
        return status;
    status = choose_device(*pointer, options);
    if (status == STATUS_DONE) {
        inspect_device(*pointer, (*pointer)->devices[(*pointer)->chosen_device]);
        status = open_device(*pointer);
    }
    if (status != STATUS_DONE)
        vulkan_context_destroy(pointer);
    return status;
}

static void close_device(struct vulkan_context *context)
{
    if (context->device)
        vkDestroyDevice(context->device, NULL);
    context->device = NULL;
    context->lost = false;
    context->arithmetic = (struct arithmetic){0};
}

enum status vulkan_context_destroy(struct vulkan_context **pointer)
{
    struct vulkan_context *context = *pointer;
    *pointer = NULL;
    if (!context)
        return STATUS_DONE;
    if (context->hung) /* all is left as it is, for the device */
        return STATUS_UNABLE;
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
static void print_device(const struct vulkan_context *context, uint32_t index, bool usable)
{
    const VkPhysicalDeviceProperties *properties = &context->properties;
    const VkPhysicalDeviceLimits *limits = &properties->limits;
    const uint32_t *group = limits->maxComputeWorkGroupSize;
    printf("%c %" PRIu32 "  %s\n", index == context->chosen_device ? '*' : ' ', index,
           properties->deviceName);
    printf("      type            %s\n", device_type(context).name);
    printf("      driver          %s %s\n", context->driver.driverName, context->driver.driverInfo);
    printf("      Vulkan          %u.%u.%u%s\n", VK_API_VERSION_MAJOR(properties->apiVersion),
           VK_API_VERSION_MINOR(properties->apiVersion), VK_API_VERSION_PATCH(properties->apiVersion),
           usable ? "" : " (cannot be used: Vulkan 1.2 and a compute queue are needed)");
    printf("      fp64            %s\n", context->has_float64 ? "yes" : "no");
    printf("      storage buffer  %" PRIu32 " bytes\n", limits->maxStorageBufferRange);
    printf("      uniform buffer  %" PRIu32 " bytes\n", limits->maxUniformBufferRange);
    printf("      group           %" PRIu32 " x %" PRIu32 " x %" PRIu32 ", %" PRIu32 " invocations\n",
           group[0], group[1], group[2], limits->maxComputeWorkGroupInvocations);
}

enum status vulkan_print_devices(const struct vulkan_options *options,
                                 enum status (*print_more)(struct vulkan_context *))
{
    struct vulkan_context *context;
    enum status status = create_context(options, &context);
    if (status != STATUS_DONE)
        return status;
    const enum status chosen = choose_device(context, options);
    for (uint32_t i = 0; i < context->device_count && status == STATUS_DONE; ++i) {
        bool usable = inspect_device(context, context->devices[i]);
        print_device(context, i, usable);
        if (usable)
            status = open_device(context);
        if (usable && status == STATUS_DONE)
            status = print_more(context);
        close_device(context);
    }
    enum status closed = vulkan_context_destroy(&context);
    return status != STATUS_DONE ? status : chosen != STATUS_DONE ? chosen : closed;
}
