#include <string.h>

#include "tracer_private.h"

static void record_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                           VkPipelineStageFlags to, VkAccessFlags read)
{
    vkCmdPipelineBarrier(commands, from, to, 0, 1,
                         &(VkMemoryBarrier){
                             .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                             .srcAccessMask = written,
                             .dstAccessMask = read,
                         },
                         0, NULL, 0, NULL);
}

static enum status record_tile(struct tracer *tracer, struct window tile, uint32_t first_sample,
                               uint32_t end_sample)
{
    const VkCommandBuffer commands = tracer->commands;
    const struct push_constants constants = {
        tile.x,       tile.y,    tile.width, tile.height, tracer->picture_width, tracer->picture_height,
        first_sample, end_sample};
    VULKAN_CALL(vkBeginCommandBuffer, commands,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, tracer->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, tracer->pipeline_layout, 0, 1,
                            &tracer->set, 0, NULL);
    vkCmdPushConstants(commands, tracer->pipeline_layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants,
                       &constants);
    record_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    if (tracer->timestamps) {
        vkCmdResetQueryPool(commands, tracer->timestamps, 0, 2);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, tracer->timestamps, 0);
    }
    unsigned group_rows = tracer->shape.height * tracer->shape.rows;
    vkCmdDispatch(commands, (tile.width + tracer->shape.width - 1) / tracer->shape.width,
                  (tile.height + group_rows - 1) / group_rows, 1);
    if (tracer->timestamps)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, tracer->timestamps, 1);
    if (tracer->staging.buffer) {
        record_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        vkCmdCopyBuffer(commands, tracer->picture.buffer, tracer->staging.buffer, 1,
                        &(VkBufferCopy){
                            .size = (VkDeviceSize)tile.width * tile.height * pixel_size(tracer),
                        });
        record_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    } else {
        record_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                       VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    }
    VULKAN_CALL(vkEndCommandBuffer, commands);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* Adds the samples to the tile in the buffer that the host reads, and the device's time to *dispatch_ms. */
static enum status dispatch_tile(struct tracer *tracer, struct window tile, uint32_t first_sample,
                                 uint32_t end_sample, double *dispatch_ms)
{
    const VkDevice device = tracer->context->device;
    enum status status = record_tile(tracer, tile, first_sample, end_sample);
    if (status != STATUS_DONE)
        return status;
    double start = clock_ms();
    VULKAN_CALL(vkQueueSubmit, tracer->context->queue, 1,
                &(VkSubmitInfo){
                    .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 1,
                    .pCommandBuffers = &tracer->commands,
                },
                tracer->fence);
    VULKAN_CALL(vkWaitForFences, device, 1, &tracer->fence, VK_TRUE, UINT64_MAX);
    VULKAN_CALL(vkResetFences, device, 1, &tracer->fence);
    if (tracer->timestamps) {
        uint64_t ticks[2];
        VULKAN_CALL(vkGetQueryPoolResults, device, tracer->timestamps, 0, 2, sizeof ticks, ticks,
                    sizeof *ticks, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        uint64_t mask = UINT64_MAX >> (64 - tracer->context->timestamp_bits);
        *dispatch_ms += (double)((ticks[1] - ticks[0]) & mask) *
                        (double)tracer->context->properties.limits.timestampPeriod * 1e-6;
    } else {
        *dispatch_ms += clock_ms() - start;
    }
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static const void *tile_values(const struct tracer *tracer)
{
    return tracer->staging.buffer ? tracer->staging.mapped : tracer->picture.mapped;
}

/* Whether the driver ended a loop early: the shader marks such pixels with -1. */
static bool was_cut(const struct tracer *tracer, struct window tile)
{
    const float *floats = tile_values(tracer);
    const double *doubles = tile_values(tracer);
    size_t count = (size_t)tile.width * tile.height * CHANNELS;
    for (size_t i = 0; i < count; i += CHANNELS)
        if (tracer->double_precision ? doubles[i] < 0 : floats[i] < 0)
            return true;
    return false;
}

/* Renders the tile's samples, a part of them at a time. Lavapipe ends loops after 65535 turns of all loops of
 * an invocation together: where that shows, one pixel and one sample at a time have to do from then on. */
static enum status render_tile(struct tracer *tracer, struct window tile, double *dispatch_ms)
{
    const uint32_t samples = (uint32_t)tracer->packed->samples;
    for (uint32_t first = 0, end; first < samples; first = end) {
        end = samples - first < tracer->samples_per_dispatch ? samples : first + tracer->samples_per_dispatch;
        enum status status =
            interrupt_requested() ? STATUS_INTERRUPTED : dispatch_tile(tracer, tile, first, end, dispatch_ms);
        if (status != STATUS_DONE)
            return status;
    }
    if (!was_cut(tracer, tile))
        return STATUS_DONE;
    if (tracer->shape.rows == 1 && tracer->samples_per_dispatch == 1) {
        log_error("%s ended a loop of the shader early (lavapipe does so after 65535 turns in a pixel): "
                  "fewer bounces or light samples are needed",
                  tracer->context->properties.deviceName);
        return STATUS_UNABLE;
    }
    log_info("the driver ended a loop early; going on with one pixel and sample at a time");
    tracer->shape.rows = 1;
    tracer->samples_per_dispatch = 1;
    vkDestroyPipeline(tracer->context->device, tracer->pipeline, NULL);
    tracer->pipeline = VK_NULL_HANDLE;
    enum status status = tracer_build_pipeline(tracer);
    return status == STATUS_DONE ? render_tile(tracer, tile, dispatch_ms) : status;
}

/* Copies the finished tile into its place in the image of the window. */
static void copy_tile(const struct tracer *tracer, struct window window, struct window tile,
                      struct image *image)
{
    const float *floats = tile_values(tracer);
    const double *doubles = tile_values(tracer);
    size_t count = (size_t)tile.width * CHANNELS;
    for (unsigned row = 0; row < tile.height; ++row) {
        size_t from = row * count;
        size_t to = ((size_t)(tile.y - window.y + row) * window.width + (tile.x - window.x)) * CHANNELS;
        if (!tracer->double_precision) {
            memcpy(image->rgb + to, floats + from, count * sizeof *floats);
            continue;
        }
        for (size_t i = 0; i < count; ++i)
            image->rgb[to + i] = (float)doubles[from + i];
        if (image->rgb64)
            memcpy(image->rgb64 + to, doubles + from, count * sizeof *doubles);
    }
}

enum status tracer_render(struct tracer *tracer, struct window window, struct image *image,
                          struct progress *progress, double *dispatch_ms)
{
    unsigned tile_width = window.width < 1024 ? window.width : 1024;
    if (tile_width > tracer->tile_pixels)
        tile_width = tracer->tile_pixels;
    unsigned tile_height = tracer->tile_pixels / tile_width;
    *dispatch_ms = 0;
    for (unsigned y = 0; y < window.height; y += tile_height) {
        for (unsigned x = 0; x < window.width; x += tile_width) {
            if (interrupt_requested())
                return STATUS_INTERRUPTED;
            struct window tile = {
                .x = window.x + x,
                .y = window.y + y,
                .width = window.width - x < tile_width ? window.width - x : tile_width,
                .height = window.height - y < tile_height ? window.height - y : tile_height,
            };
            enum status status = render_tile(tracer, tile, dispatch_ms);
            if (status != STATUS_DONE)
                return status;
            copy_tile(tracer, window, tile, image);
            progress_advance(progress, (uint64_t)tile.width * tile.height);
        }
    }
    return STATUS_DONE;
}
