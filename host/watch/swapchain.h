#ifndef VKWHITTED_WATCH_SWAPCHAIN_H
#define VKWHITTED_WATCH_SWAPCHAIN_H

#include "vulkan/context.h"
#include "watch/fit.h"

struct GLFWwindow;
struct swapchain;

/* A window's surface, and the images that are shown on it. The context presents; context and window must
 * outlive the swapchain. On failure (reported) *swapchain is NULL. */
enum status swapchain_create(struct vulkan_context *context, struct GLFWwindow *window,
                             struct swapchain **swapchain);

/* Shows the picture, scaled to fit the surface as large as that is now; the bytes shown are the bytes given.
 * *shown is false where nothing can be shown at the moment: the surface is empty, or its images are all in
 * use. STATUS_UNABLE (reported unless the window system is lost): nothing will be shown any more. Uses the
 * context's queue. */
enum status swapchain_show(struct swapchain *swapchain, const struct rgba_picture *picture, bool *shown);

void swapchain_destroy(struct swapchain **swapchain);

#endif
