#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "tracer/tracer_private.h"
#include "vulkan/debug.h"

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

/* What a dispatch does for each pixel of its tile. */
struct portion {
    uint32_t first_sample, end_sample;
    bool goes_on; /* with what the dispatch before has left */
};

static enum status record_tile(struct tracer *tracer, struct window tile, struct portion portion)
{
    const VkCommandBuffer commands = tracer->commands;
    const struct push_constants constants = {
        tile.x,
        tile.y,
        tile.width,
        tile.height,
        tracer->picture_width,
        tracer->picture_height,
        portion.first_sample,
        portion.end_sample,
        portion.goes_on,
    };
    VULKAN_CALL(vkBeginCommandBuffer, commands,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    char label[96];
    snprintf(label, sizeof label, "tile of %ux%u at %u, %u, samples %u to %u", tile.width, tile.height,
             tile.x, tile.y, portion.first_sample, portion.end_sample);
    vulkan_label_begin(tracer->context, commands, label);
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
                       VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                       VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_HOST_READ_BIT);
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
    vulkan_label_end(tracer->context, commands);
    VULKAN_CALL(vkEndCommandBuffer, commands);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* Adds the portion to the tile in the buffer that the host reads, and the device's time to *dispatch_ms. */
static enum status dispatch_tile(struct tracer *tracer, struct window tile, struct portion portion,
                                 double *dispatch_ms)
{
    const VkDevice device = tracer->context->device;
    enum status status = interrupt_requested() ? STATUS_INTERRUPTED : record_tile(tracer, tile, portion);
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

/* The lowest mark of a pixel that has no value yet, UNFINISHED or TOO_LONG, or something lower where ended
 * loops have left a pixel as it was in memory; 0 if all have values. */
static double tile_mark(const struct tracer *tracer, struct window tile)
{
    const float *floats = tile_values(tracer);
    const double *doubles = tile_values(tracer);
    size_t count = (size_t)tile.width * tile.height * CHANNELS;
    double mark = 0;
    for (size_t i = 0; i < count; i += CHANNELS) {
        double value = tracer->double_precision ? doubles[i] : (double)floats[i];
        mark = value < mark ? value : mark;
    }
    return mark;
}

/* Renders the tile's samples, a part of them at a time. *too_long: the driver may have ended loops early. */
static enum status render_tile(struct tracer *tracer, struct window tile, double *dispatch_ms, bool *too_long)
{
    const uint32_t samples = (uint32_t)tracer->packed->samples;
    enum status status = STATUS_DONE;
    *too_long = false;
    for (uint32_t first = 0, end; first < samples && status == STATUS_DONE && !*too_long; first = end) {
        end = samples - first < tracer->samples_per_dispatch ? samples : first + tracer->samples_per_dispatch;
        struct portion portion = {first, end, false};
        double mark;
        do {
            status = dispatch_tile(tracer, tile, portion, dispatch_ms);
            mark = status == STATUS_DONE ? tile_mark(tracer, tile) : 0;
            portion.goes_on = true;
        } while (mark == UNFINISHED);
        *too_long = mark <= TOO_LONG;
    }
    return status;
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

static enum status render_tiles(struct tracer *tracer, struct window window, struct image *image,
                                struct progress *progress, double *dispatch_ms, bool *too_long)
{
    /* an invocation traces all its rows, also those below the tile: whole ones, if possible */
    const unsigned rows = tracer->shape.rows;
    unsigned tile_width = window.width < 1024 ? window.width : 1024;
    if (tile_width > tracer->tile_pixels / rows)
        tile_width = tracer->tile_pixels > rows ? tracer->tile_pixels / rows : 1;
    unsigned tile_height = tracer->tile_pixels / tile_width;
    tile_height -= tile_height > rows ? tile_height % rows : 0;
    for (unsigned y = 0; y < window.height; y += tile_height) {
        for (unsigned x = 0; x < window.width; x += tile_width) {
            struct window tile = {
                .x = window.x + x,
                .y = window.y + y,
                .width = window.width - x < tile_width ? window.width - x : tile_width,
                .height = window.height - y < tile_height ? window.height - y : tile_height,
            };
            enum status status = render_tile(tracer, tile, dispatch_ms, too_long);
            if (status != STATUS_DONE || *too_long)
                return status;
            copy_tile(tracer, window, tile, image);
            progress_advance(progress, (uint64_t)tile.width * tile.height);
        }
    }
    return STATUS_DONE;
}

enum status tracer_render(struct tracer *tracer, struct window window, struct image *image,
                          struct progress *progress, double *dispatch_ms)
{
    uint64_t done = progress->done;
    bool too_long = false;
    *dispatch_ms = 0;
    enum status status = render_tiles(tracer, window, image, progress, dispatch_ms, &too_long);
    if (status == STATUS_DONE && too_long && !tracer->resumable) {
        log_info("the driver may have ended loops early; going on in smaller portions");
        progress->done = done;
        *dispatch_ms = 0;
        status = tracer_become_resumable(tracer);
        if (status == STATUS_DONE)
            status = render_tiles(tracer, window, image, progress, dispatch_ms, &too_long);
    }
    if (status != STATUS_DONE || !too_long)
        return status;
    log_error("%s ends the shader's loops after 65535 turns, too early for so many light samples",
              tracer->context->properties.deviceName);
    return STATUS_UNABLE;
}
