#ifndef VKWHITTED_WATCH_SWAPCHAIN_H
#define VKWHITTED_WATCH_SWAPCHAIN_H

#include "vulkan/context.h"

struct GLFWwindow;

/* A window's surface, and a picture that is shown on it. */
struct swapchain;

/* The context presents; context and window must outlive the swapchain. On failure (reported) *swapchain is
 * NULL. */
enum status swapchain_create(struct vulkan_context *context, struct GLFWwindow *window,
                             struct swapchain **swapchain);
void swapchain_destroy(struct swapchain **swapchain);

/* Where the next picture goes: RGBA, row 0 on top, what A is does not matter. The memory stays the
 * swapchain's. NULL (reported): the device has no images as large as that, or no memory. */
unsigned char *swapchain_picture(struct swapchain *swapchain, unsigned width, unsigned height);

/* Shows the picture in the window as large as that is now: scaled to fit, its aspect kept, the rest black. In
 * its own size the bytes shown are the bytes given; enlarged, they are those of the nearest pixel; reduced,
 * between those of the four nearest. *shown is false where nothing can be shown at the moment: the window is
 * empty, or its images are all in use. STATUS_UNABLE (reported): nothing will be shown any more. Uses the
 * context's queue. */
enum status swapchain_show(struct swapchain *swapchain, bool *shown);

/* Where a picture fits in a window; at least one pixel, unless the window is empty. */
VkRect2D fit_picture(VkExtent2D picture, VkExtent2D window);

#endif
