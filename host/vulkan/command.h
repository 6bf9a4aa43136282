#ifndef VKWHITTED_VULKAN_COMMAND_H
#define VKWHITTED_VULKAN_COMMAND_H

#include "vulkan/context.h"

enum { STARTED, ENDED, TIMESTAMPS };

/* A command buffer that is recorded, submitted and waited for, again and again. Several can be under way. */
struct vulkan_command {
    struct vulkan_context *context;
    VkCommandPool pool;
    VkCommandBuffer buffer; /* to record into, after vulkan_command_begin() */
    VkFence fence;
    VkQueryPool timestamps; /* of the dispatch in it; VK_NULL_HANDLE: the queue has none */
    double submitted_ms;    /* clock_ms() */
};

/* On failure (reported) *command is empty. */
enum status vulkan_command_create(struct vulkan_context *context, struct vulkan_command *command);

/* Destroys a command that is not under way, or nothing, and empties *command. */
void vulkan_command_destroy(struct vulkan_command *command);

/* Starts a new recording under this label, for debuggers. What is recorded sees all that was written on the
 * device before. Failures, here and below, are reported. */
enum status vulkan_command_begin(struct vulkan_command *command, const char *label);

/* Ends the recording, so that the host will see what it writes, and hands it to the device. */
enum status vulkan_command_submit(struct vulkan_command *command);

/* Waits until the device has done it. *device_ms is the time that its dispatch took by the device's
 * timestamps, or, where there are none, the time since the submission. */
enum status vulkan_command_wait(struct vulkan_command *command, double *device_ms);

/* Records that what shaders and transfers have written so far is seen by the stages that follow. */
void vulkan_record_barrier(VkCommandBuffer commands, VkPipelineStageFlags to, VkAccessFlags accesses);

#endif
