#ifndef VKWHITTED_VULKAN_COMMAND_H
#define VKWHITTED_VULKAN_COMMAND_H

#include "vulkan/context.h"

enum { STARTED, ENDED, TIMESTAMPS };

/* A command buffer that is recorded, run, again and again. */
struct vulkan_command {
    struct vulkan_context *context;
    VkCommandPool pool;
    VkCommandBuffer buffer; /* to record into, after vulkan_command_begin() */
    VkFence fence;
    VkQueryPool timestamps; /* of the dispatch in it; VK_NULL_HANDLE: the queue has none */
};

/* On failure (reported) *command is empty. */
enum status vulkan_command_create(struct vulkan_context *context, struct vulkan_command *command);

/* Destroys a command that is not under way, or nothing, and empties *command. */
void vulkan_command_destroy(struct vulkan_command *command);

/* Starts a new recording under this name, for debuggers. What is recorded sees all that was written on the
 * device before. Failures, here and below, are reported. */
enum status vulkan_command_begin(struct vulkan_command *command, const char *name);

/* Ends the recording, has the device do it and waits for that; the host sees what it wrote. *device_ms is the
 * time that its dispatch took by the device's timestamps, or, where there are none, since the submission. */
enum status vulkan_command_run(struct vulkan_command *command, double *device_ms);

/* Records that all that was written on the device so far is seen by what follows, and by the host. */
void vulkan_record_barrier(VkCommandBuffer commands);

#endif
