#include "watch/swapchain.h"

#include <stdlib.h>
#include <strings.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "vulkan/buffer.h"
#include "vulkan/command.h"

/* Nanoseconds. An image is free within a frame's time unless the window is hidden. */
static const uint64_t acquire_timeout = 100000000;

enum { MOST_IMAGES = 16 };

struct swapchain {
    struct vulkan_context *context;
    GLFWwindow *window;
    VkSurfaceKHR surface;
    VkSurfaceFormatKHR format;
    VkSwapchainKHR handle; /* VK_NULL_HANDLE: to be built anew */
    VkExtent2D extent;
    VkImage images[MOST_IMAGES];
    struct vulkan_command command; /* its fence tells that an image has been acquired, too */

    VkExtent2D picture_extent;
    struct vulkan_buffer pixels; /* the picture, as the host writes it */
    VkImage picture;             /* the same for the device to scale */
    VkDeviceMemory picture_memory;
};

/* Four bytes in this order, without conversion: the bytes are encoded already. */
static bool is_usable(VkSurfaceFormatKHR format)
{
    return format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR &&
           (format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM);
}

static enum status create_surface(struct swapchain *swapchain)
{
    const struct vulkan_context *context = swapchain->context;
    VkBool32 supported;
    VkSurfaceFormatKHR formats[64];
    uint32_t count = sizeof formats / sizeof *formats;
    VULKAN_CALL(glfwCreateWindowSurface, context->instance, swapchain->window, NULL, &swapchain->surface);
    VULKAN_CALL(vkGetPhysicalDeviceSurfaceSupportKHR, context->physical_device, context->queue_family,
                swapchain->surface, &supported);
    VULKAN_CALL(vkGetPhysicalDeviceSurfaceFormatsKHR, context->physical_device, swapchain->surface, &count,
                formats);
    for (uint32_t i = 0; i < count && supported; ++i) {
        swapchain->format = formats[i];
        if (is_usable(formats[i]))
            return STATUS_DONE;
    }
    log_error("%s cannot show pictures of 8-bit RGBA or BGRA in this window", context->properties.deviceName);

error:
    return STATUS_UNABLE;
}

enum status swapchain_create(struct vulkan_context *context, GLFWwindow *window, struct swapchain **pointer)
{
    struct swapchain *swapchain = *pointer = calloc(1, sizeof *swapchain);
    if (!swapchain) {
        log_error("no memory for the window's swapchain");
        return STATUS_UNABLE;
    }
    swapchain->context = context;
    swapchain->window = window;
    if (create_surface(swapchain) == STATUS_DONE &&
        vulkan_command_create(context, &swapchain->command) == STATUS_DONE)
        return STATUS_DONE;
    swapchain_destroy(pointer);
    return STATUS_UNABLE;
}

static void destroy_picture(struct swapchain *swapchain)
{
    vkDestroyImage(swapchain->context->device, swapchain->picture, NULL);
    vkFreeMemory(swapchain->context->device, swapchain->picture_memory, NULL);
    vulkan_buffer_destroy(swapchain->context, &swapchain->pixels);
    swapchain->picture = VK_NULL_HANDLE;
    swapchain->picture_memory = VK_NULL_HANDLE;
    swapchain->picture_extent = (VkExtent2D){0};
}

void swapchain_destroy(struct swapchain **pointer)
{
    struct swapchain *swapchain = *pointer;
    *pointer = NULL;
    if (!swapchain)
        return;
    const VkDevice device = swapchain->context->device;
    vkQueueWaitIdle(swapchain->context->queue);
    destroy_picture(swapchain);
    vkDestroySwapchainKHR(device, swapchain->handle, NULL);
    vulkan_command_destroy(&swapchain->command);
    if (swapchain->surface)
        vkDestroySurfaceKHR(swapchain->context->instance, swapchain->surface, NULL);
    free(swapchain);
}

static enum status create_picture(struct swapchain *swapchain, VkExtent2D extent)
{
    struct vulkan_context *context = swapchain->context;
    VkMemoryRequirements needs;
    VULKAN_CALL(vkCreateImage, context->device,
                &(VkImageCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                    .imageType = VK_IMAGE_TYPE_2D,
                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                    .extent = {extent.width, extent.height, 1},
                    .mipLevels = 1,
                    .arrayLayers = 1,
                    .samples = VK_SAMPLE_COUNT_1_BIT,
                    .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                },
                NULL, &swapchain->picture);
    vkGetImageMemoryRequirements(context->device, swapchain->picture, &needs);
    VULKAN_CALL(vkAllocateMemory, context->device,
                &(VkMemoryAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                    .allocationSize = needs.size,
                    .memoryTypeIndex = (uint32_t)ffs((int)needs.memoryTypeBits) - 1, /* the fastest first */
                },
                NULL, &swapchain->picture_memory);
    VULKAN_CALL(vkBindImageMemory, context->device, swapchain->picture, swapchain->picture_memory, 0);
    return vulkan_buffer_create(context, "picture for the window",
                                4 * (VkDeviceSize)extent.width * extent.height,
                                VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BUFFER_UPLOAD, &swapchain->pixels);

error:
    return STATUS_UNABLE;
}

unsigned char *swapchain_picture(struct swapchain *swapchain, unsigned width, unsigned height)
{
    uint32_t most = swapchain->context->properties.limits.maxImageDimension2D;
    const VkExtent2D old = swapchain->picture_extent, extent = {width, height};
    if (old.width == width && old.height == height)
        return swapchain->pixels.mapped;
    destroy_picture(swapchain);
    if (width > most || height > most)
        log_error("a window shows pictures of up to %ux%u pixels, not %ux%u", most, most, width, height);
    else if (create_picture(swapchain, extent) == STATUS_DONE)
        swapchain->picture_extent = extent;
    return swapchain->picture_extent.width > 0 ? swapchain->pixels.mapped : NULL;
}

/* a b / c, rounded to nearest, at least 1. */
static uint32_t scale(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t scaled = (uint32_t)(((uint64_t)a * b + c / 2) / c);
    return scaled > 0 ? scaled : 1;
}

VkRect2D fit_picture(VkExtent2D picture, VkExtent2D window)
{
    VkExtent2D fit = window;
    if (window.width == 0 || window.height == 0)
        return (VkRect2D){0};
    if ((uint64_t)window.width * picture.height <= (uint64_t)window.height * picture.width)
        fit.height = scale(picture.height, window.width, picture.width);
    else
        fit.width = scale(picture.width, window.height, picture.height);
    return (VkRect2D){
        {(int32_t)((window.width - fit.width) / 2), (int32_t)((window.height - fit.height) / 2)}, fit};
}

static enum status build(struct swapchain *swapchain, const VkSurfaceCapabilitiesKHR *capabilities)
{
    const VkDevice device = swapchain->context->device;
    uint32_t count = capabilities->minImageCount + 1;
    if (capabilities->maxImageCount > 0 && count > capabilities->maxImageCount)
        count = capabilities->maxImageCount;
    bool opaque = capabilities->supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    VULKAN_CALL(
        vkCreateSwapchainKHR, device,
        &(VkSwapchainCreateInfoKHR){
            .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
            .surface = swapchain->surface,
            .minImageCount = count,
            .imageFormat = swapchain->format.format,
            .imageColorSpace = swapchain->format.colorSpace,
            .imageExtent = swapchain->extent,
            .imageArrayLayers = 1,
            .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
            .preTransform = capabilities->currentTransform,
            .compositeAlpha = opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
            .presentMode = VK_PRESENT_MODE_FIFO_KHR,
            .clipped = VK_TRUE,
        },
        NULL, &swapchain->handle);
    count = MOST_IMAGES;
    VULKAN_CALL(vkGetSwapchainImagesKHR, device, swapchain->handle, &count, swapchain->images);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* Makes a swapchain as large as the window, unless there is one. There is none while the window is empty. */
static enum status keep_size(struct swapchain *swapchain)
{
    VkSurfaceCapabilitiesKHR capabilities;
    int width, height;
    VULKAN_CALL(vkGetPhysicalDeviceSurfaceCapabilitiesKHR, swapchain->context->physical_device,
                swapchain->surface, &capabilities);
    VkExtent2D extent = capabilities.currentExtent;
    if (extent.width == UINT32_MAX) { /* whatever one wants */
        glfwGetFramebufferSize(swapchain->window, &width, &height);
        extent = (VkExtent2D){(uint32_t)width, (uint32_t)height};
    }
    if (swapchain->handle && extent.width == swapchain->extent.width &&
        extent.height == swapchain->extent.height)
        return STATUS_DONE;
    vkQueueWaitIdle(swapchain->context->queue);
    vkDestroySwapchainKHR(swapchain->context->device, swapchain->handle, NULL);
    swapchain->handle = VK_NULL_HANDLE;
    swapchain->extent = extent;
    return extent.width > 0 && extent.height > 0 ? build(swapchain, &capabilities) : STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* The image goes from one layout and use to the next; whatever is transferred before is complete then. */
static void change_layout(struct swapchain *swapchain, VkImage image, VkImageLayout from, VkImageLayout to)
{
    const VkAccessFlags transfer = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    vkCmdPipelineBarrier(swapchain->command.buffer, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1,
                         &(VkImageMemoryBarrier){
                             .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                             .srcAccessMask = transfer,
                             .dstAccessMask = transfer,
                             .oldLayout = from,
                             .newLayout = to,
                             .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                             .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                             .image = image,
                             .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
                         });
}

/* The picture is uploaded and scaled into the image. */
static void record(struct swapchain *swapchain, VkImage image)
{
    const VkCommandBuffer commands = swapchain->command.buffer;
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkExtent2D size = swapchain->picture_extent;
    const VkRect2D fit = fit_picture(size, swapchain->extent);
    const VkOffset3D end = {fit.offset.x + (int32_t)fit.extent.width,
                            fit.offset.y + (int32_t)fit.extent.height, 1};
    bool enlarged = fit.extent.width >= size.width && fit.extent.height >= size.height;
    change_layout(swapchain, swapchain->picture, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(
        commands, swapchain->pixels.buffer, swapchain->picture, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
        &(VkBufferImageCopy){.imageSubresource = layers, .imageExtent = {size.width, size.height, 1}});
    change_layout(swapchain, swapchain->picture, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    change_layout(swapchain, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         &(VkClearColorValue){.float32 = {0, 0, 0, 1}}, 1,
                         &(VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1});
    change_layout(swapchain, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdBlitImage(commands, swapchain->picture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                   &(VkImageBlit){
                       .srcSubresource = layers,
                       .srcOffsets = {{0}, {(int32_t)size.width, (int32_t)size.height, 1}},
                       .dstSubresource = layers,
                       .dstOffsets = {{fit.offset.x, fit.offset.y, 0}, end},
                   },
                   enlarged ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    change_layout(swapchain, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

static enum status wait_for_fence(const struct swapchain *swapchain)
{
    const VkDevice device = swapchain->context->device;
    VULKAN_CALL(vkWaitForFences, device, 1, &swapchain->command.fence, VK_TRUE, UINT64_MAX);
    VULKAN_CALL(vkResetFences, device, 1, &swapchain->command.fence);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* Draws into the image that is being acquired, and waits until that is done. */
static enum status draw(struct swapchain *swapchain, VkImage image)
{
    if (wait_for_fence(swapchain) != STATUS_DONE ||
        vulkan_command_begin(&swapchain->command, "picture in the window") != STATUS_DONE)
        return STATUS_UNABLE;
    record(swapchain, image);
    return vulkan_command_submit(&swapchain->command) == STATUS_DONE ? wait_for_fence(swapchain)
                                                                     : STATUS_UNABLE;
}

enum status swapchain_show(struct swapchain *swapchain, bool *shown)
{
    uint32_t index;
    *shown = false;
    if (keep_size(swapchain) != STATUS_DONE)
        return STATUS_UNABLE;
    if (!swapchain->handle || swapchain->picture_extent.width == 0)
        return STATUS_DONE;
    VkResult result = vkAcquireNextImageKHR(swapchain->context->device, swapchain->handle, acquire_timeout,
                                            VK_NULL_HANDLE, swapchain->command.fence, &index);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
        if (draw(swapchain, swapchain->images[index]) != STATUS_DONE)
            return STATUS_UNABLE;
        result = vkQueuePresentKHR(swapchain->context->queue, &(VkPresentInfoKHR){
                                                                  .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                                                  .swapchainCount = 1,
                                                                  .pSwapchains = &swapchain->handle,
                                                                  .pImageIndices = &index,
                                                              });
    }
    *shown = result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR;
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
        swapchain->extent = (VkExtent2D){0}; /* the next call builds another one */
    if (*shown || result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_NOT_READY || result == VK_TIMEOUT)
        return STATUS_DONE;
    log_error("showing a picture: %s", vulkan_result_name(result));
    return STATUS_UNABLE;
}
