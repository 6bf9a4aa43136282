#include "watch/swapchain.h"

#include <stdlib.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "vulkan/buffer.h"
#include "watch/window_system.h"

/* Nanoseconds. An image is free within a frame's time unless the window is hidden. */
static const uint64_t acquire_timeout = 100000000, fence_timeout = 10000000000;

struct swapchain {
    struct vulkan_context *context;
    GLFWwindow *window;
    VkSurfaceKHR surface;
    VkSwapchainKHR handle; /* VK_NULL_HANDLE: to be built anew */
    VkExtent2D extent;
    bool blue_first;
    uint32_t image_count;
    VkImage *images;
    VkSemaphore *drawn; /* one an image */
    struct vulkan_buffer pixels;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
};

static void destroy_images(struct swapchain *swapchain)
{
    VkDevice device = swapchain->context->device;
    vkQueueWaitIdle(swapchain->context->queue);
    for (uint32_t i = 0; swapchain->drawn && i < swapchain->image_count; ++i)
        vkDestroySemaphore(device, swapchain->drawn[i], NULL);
    free(swapchain->drawn);
    free(swapchain->images);
    swapchain->drawn = NULL;
    swapchain->images = NULL;
    swapchain->image_count = 0;
    vulkan_buffer_destroy(swapchain->context, &swapchain->pixels);
    vkDestroySwapchainKHR(device, swapchain->handle, NULL);
    swapchain->handle = VK_NULL_HANDLE;
}

static void destroy_surface(struct swapchain *swapchain)
{
    if (swapchain->surface)
        vkDestroySurfaceKHR(swapchain->context->instance, swapchain->surface, NULL);
    swapchain->surface = VK_NULL_HANDLE;
}

/* An error that a display gone away explains is not worth a message of its own. */
static enum status fail(const char *call, VkResult result)
{
    if (!window_system_lost())
        log_error("%s: %s", call, vulkan_result_name(result));
    return STATUS_UNABLE;
}

/* fail() with the name of the call that gave the result. */
#define FAIL_UNLESS_SUCCESS(function, ...)                                                                   \
    do {                                                                                                     \
        VkResult result_ = function(__VA_ARGS__);                                                            \
        if (result_ != VK_SUCCESS)                                                                           \
            return fail(#function, result_);                                                                 \
    } while (0)

static enum status create_surface(struct swapchain *swapchain)
{
    const struct vulkan_context *context = swapchain->context;
    VkBool32 supported;
    if (window_system_lost())
        return STATUS_UNABLE;
    FAIL_UNLESS_SUCCESS(glfwCreateWindowSurface, context->instance, swapchain->window, NULL,
                        &swapchain->surface);
    FAIL_UNLESS_SUCCESS(vkGetPhysicalDeviceSurfaceSupportKHR, context->physical_device, context->queue_family,
                        swapchain->surface, &supported);
    if (supported)
        return STATUS_DONE;
    log_error("%s cannot show pictures in this window", context->properties.deviceName);
    return STATUS_UNABLE;
}

/* Formats whose texels are four bytes in this order; bytes are copied, so that sRGB needs no conversion. */
static bool is_usable(VkSurfaceFormatKHR format, bool *blue_first)
{
    *blue_first = format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_B8G8R8A8_SRGB;
    return format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR &&
           (*blue_first || format.format == VK_FORMAT_R8G8B8A8_UNORM ||
            format.format == VK_FORMAT_R8G8B8A8_SRGB);
}

static enum status choose_format(struct swapchain *swapchain, VkSurfaceFormatKHR *format)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = sizeof formats / sizeof *formats;
    VkResult result = vkGetPhysicalDeviceSurfaceFormatsKHR(swapchain->context->physical_device,
                                                           swapchain->surface, &count, formats);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        return fail("vkGetPhysicalDeviceSurfaceFormatsKHR", result);
    for (uint32_t i = 0; i < count; ++i) {
        *format = formats[i];
        if (is_usable(*format, &swapchain->blue_first))
            return STATUS_DONE;
    }
    log_error("the window takes no pictures of 8-bit RGBA or BGRA");
    return STATUS_UNABLE;
}

static enum status create_images(struct swapchain *swapchain)
{
    VkDevice device = swapchain->context->device;
    uint32_t count;
    FAIL_UNLESS_SUCCESS(vkGetSwapchainImagesKHR, device, swapchain->handle, &count, NULL);
    swapchain->images = calloc(count, sizeof *swapchain->images);
    swapchain->drawn = calloc(count, sizeof *swapchain->drawn);
    if (!swapchain->images || !swapchain->drawn) {
        log_error("no memory for the window's %u images", count);
        return STATUS_UNABLE;
    }
    swapchain->image_count = count;
    FAIL_UNLESS_SUCCESS(vkGetSwapchainImagesKHR, device, swapchain->handle, &count, swapchain->images);
    for (uint32_t i = 0; i < count; ++i)
        FAIL_UNLESS_SUCCESS(vkCreateSemaphore, device,
                            &(VkSemaphoreCreateInfo){.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO}, NULL,
                            &swapchain->drawn[i]);
    return vulkan_buffer_create(swapchain->context, "picture for the window",
                                4 * (VkDeviceSize)swapchain->extent.width * swapchain->extent.height,
                                VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BUFFER_UPLOAD, &swapchain->pixels);
}

static enum status build(struct swapchain *swapchain, const VkSurfaceCapabilitiesKHR *capabilities)
{
    VkSurfaceFormatKHR format;
    enum status status = choose_format(swapchain, &format);
    if (status != STATUS_DONE)
        return status;
    if (!(capabilities->supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) {
        log_error("the window's images cannot be copied to");
        return STATUS_UNABLE;
    }
    uint32_t image_count = capabilities->minImageCount + 1;
    if (capabilities->maxImageCount > 0 && image_count > capabilities->maxImageCount)
        image_count = capabilities->maxImageCount;
    bool opaque = capabilities->supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    FAIL_UNLESS_SUCCESS(
        vkCreateSwapchainKHR, swapchain->context->device,
        &(VkSwapchainCreateInfoKHR){
            .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
            .surface = swapchain->surface,
            .minImageCount = image_count,
            .imageFormat = format.format,
            .imageColorSpace = format.colorSpace,
            .imageExtent = swapchain->extent,
            .imageArrayLayers = 1,
            .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
            .preTransform = capabilities->currentTransform,
            .compositeAlpha = opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
            .presentMode = VK_PRESENT_MODE_FIFO_KHR,
            .clipped = VK_TRUE,
        },
        NULL, &swapchain->handle);
    return create_images(swapchain);
}

static VkExtent2D choose_extent(const struct swapchain *swapchain,
                                const VkSurfaceCapabilitiesKHR *capabilities)
{
    if (capabilities->currentExtent.width != UINT32_MAX)
        return capabilities->currentExtent;
    int width, height;
    glfwGetFramebufferSize(swapchain->window, &width, &height);
    const VkExtent2D least = capabilities->minImageExtent, most = capabilities->maxImageExtent;
    VkExtent2D extent = {(uint32_t)width, (uint32_t)height};
    if (extent.width == 0 || extent.height == 0)
        return extent;
    extent.width = extent.width < least.width ? least.width : extent.width;
    extent.height = extent.height < least.height ? least.height : extent.height;
    extent.width = extent.width > most.width ? most.width : extent.width;
    extent.height = extent.height > most.height ? most.height : extent.height;
    return extent;
}

/* Makes a swapchain as large as the surface. VK_NOT_READY: there is none while that is empty. */
static enum status keep_size(struct swapchain *swapchain, VkResult *result)
{
    VkSurfaceCapabilitiesKHR capabilities;
    if (!swapchain->surface && create_surface(swapchain) != STATUS_DONE)
        return STATUS_UNABLE;
    *result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(swapchain->context->physical_device,
                                                        swapchain->surface, &capabilities);
    if (*result != VK_SUCCESS)
        return STATUS_DONE;
    VkExtent2D extent = choose_extent(swapchain, &capabilities);
    if (swapchain->handle && extent.width == swapchain->extent.width &&
        extent.height == swapchain->extent.height)
        return STATUS_DONE;
    destroy_images(swapchain);
    swapchain->extent = extent;
    if (extent.width > 0 && extent.height > 0)
        return build(swapchain, &capabilities);
    *result = VK_NOT_READY;
    return STATUS_DONE;
}

static void add_barrier(struct swapchain *swapchain, VkImage image, const VkImageMemoryBarrier *barrier,
                        VkPipelineStageFlags before, VkPipelineStageFlags after)
{
    VkImageMemoryBarrier full = *barrier;
    full.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    full.srcQueueFamilyIndex = full.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    full.image = image;
    full.subresourceRange = (VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(swapchain->commands, before, after, 0, 0, NULL, 0, NULL, 1, &full);
}

static enum status record_copy(struct swapchain *swapchain, VkImage image)
{
    FAIL_UNLESS_SUCCESS(vkBeginCommandBuffer, swapchain->commands,
                        &(VkCommandBufferBeginInfo){
                            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                        });
    add_barrier(swapchain, image,
                &(VkImageMemoryBarrier){
                    .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                    .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                    .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                },
                VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT);
    vkCmdCopyBufferToImage(swapchain->commands, swapchain->pixels.buffer, image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &(VkBufferImageCopy){
                               .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .imageExtent = {swapchain->extent.width, swapchain->extent.height, 1},
                           });
    add_barrier(swapchain, image,
                &(VkImageMemoryBarrier){
                    .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                    .oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    .newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                },
                VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
    FAIL_UNLESS_SUCCESS(vkEndCommandBuffer, swapchain->commands);
    return STATUS_DONE;
}

static enum status wait_for_fence(struct swapchain *swapchain)
{
    VkDevice device = swapchain->context->device;
    FAIL_UNLESS_SUCCESS(vkWaitForFences, device, 1, &swapchain->fence, VK_TRUE, fence_timeout);
    FAIL_UNLESS_SUCCESS(vkResetFences, device, 1, &swapchain->fence);
    return STATUS_DONE;
}

/* Draws into an acquired image, waits for that, and hands the image over; *result is what came of it. */
static enum status draw(struct swapchain *swapchain, const struct rgba_picture *picture, uint32_t index,
                        VkResult *result)
{
    VkQueue queue = swapchain->context->queue;
    fit_draw(picture, swapchain->extent.width, swapchain->extent.height, swapchain->blue_first,
             swapchain->pixels.mapped);
    enum status status = wait_for_fence(swapchain);
    if (status == STATUS_DONE)
        status = record_copy(swapchain, swapchain->images[index]);
    if (status != STATUS_DONE)
        return status;
    FAIL_UNLESS_SUCCESS(vkQueueSubmit, queue, 1,
                        &(VkSubmitInfo){
                            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                            .commandBufferCount = 1,
                            .pCommandBuffers = &swapchain->commands,
                            .signalSemaphoreCount = 1,
                            .pSignalSemaphores = &swapchain->drawn[index],
                        },
                        swapchain->fence);
    status = wait_for_fence(swapchain);
    *result = vkQueuePresentKHR(queue, &(VkPresentInfoKHR){
                                           .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                           .waitSemaphoreCount = 1,
                                           .pWaitSemaphores = &swapchain->drawn[index],
                                           .swapchainCount = 1,
                                           .pSwapchains = &swapchain->handle,
                                           .pImageIndices = &index,
                                       });
    return status;
}

static enum status try_to_show(struct swapchain *swapchain, const struct rgba_picture *picture,
                               VkResult *result)
{
    enum status status = keep_size(swapchain, result);
    if (status != STATUS_DONE || *result != VK_SUCCESS)
        return status;
    uint32_t index;
    *result = vkAcquireNextImageKHR(swapchain->context->device, swapchain->handle, acquire_timeout,
                                    VK_NULL_HANDLE, swapchain->fence, &index);
    if (*result == VK_SUCCESS || *result == VK_SUBOPTIMAL_KHR)
        status = draw(swapchain, picture, index, result);
    return status;
}

enum status swapchain_show(struct swapchain *swapchain, const struct rgba_picture *picture, bool *shown)
{
    enum { ATTEMPTS = 8 }; /* while someone drags the window's corner */
    VkResult result = VK_ERROR_OUT_OF_DATE_KHR;
    *shown = false;
    for (int i = 0; i < ATTEMPTS; ++i) {
        enum status status = try_to_show(swapchain, picture, &result);
        if (status != STATUS_DONE)
            return status;
        if (result != VK_ERROR_OUT_OF_DATE_KHR && result != VK_ERROR_SURFACE_LOST_KHR)
            break;
        destroy_images(swapchain);
        if (result == VK_ERROR_SURFACE_LOST_KHR)
            destroy_surface(swapchain);
    }
    *shown = result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR;
    if (*shown || result == VK_NOT_READY || result == VK_TIMEOUT || result == VK_ERROR_OUT_OF_DATE_KHR)
        return STATUS_DONE;
    return fail("showing a picture", result);
}

static enum status create_commands(struct swapchain *swapchain)
{
    const struct vulkan_context *context = swapchain->context;
    FAIL_UNLESS_SUCCESS(vkCreateCommandPool, context->device,
                        &(VkCommandPoolCreateInfo){
                            .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                            .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                            .queueFamilyIndex = context->queue_family,
                        },
                        NULL, &swapchain->pool);
    FAIL_UNLESS_SUCCESS(vkAllocateCommandBuffers, context->device,
                        &(VkCommandBufferAllocateInfo){
                            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                            .commandPool = swapchain->pool,
                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                            .commandBufferCount = 1,
                        },
                        &swapchain->commands);
    FAIL_UNLESS_SUCCESS(vkCreateFence, context->device,
                        &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO}, NULL,
                        &swapchain->fence);
    return STATUS_DONE;
}

enum status swapchain_create(struct vulkan_context *context, GLFWwindow *window, struct swapchain **swapchain)
{
    *swapchain = calloc(1, sizeof **swapchain);
    if (!*swapchain) {
        log_error("no memory for the window's swapchain");
        return STATUS_UNABLE;
    }
    (*swapchain)->context = context;
    (*swapchain)->window = window;
    enum status status = create_surface(*swapchain);
    if (status == STATUS_DONE)
        status = create_commands(*swapchain);
    if (status != STATUS_DONE)
        swapchain_destroy(swapchain);
    return status;
}

void swapchain_destroy(struct swapchain **pointer)
{
    struct swapchain *swapchain = *pointer;
    *pointer = NULL;
    if (!swapchain)
        return;
    destroy_images(swapchain);
    vkDestroyFence(swapchain->context->device, swapchain->fence, NULL);
    vkDestroyCommandPool(swapchain->context->device, swapchain->pool, NULL);
    destroy_surface(swapchain);
    free(swapchain);
}
