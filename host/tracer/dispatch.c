#include "tracer/dispatch.h"

#include <stdio.h>

#include "base/clock.h"

enum { CONSTANTS = sizeof(struct specialization) / sizeof(uint32_t) };
_Static_assert((int)CONSTANTS <= (int)PASS_MOST_CONSTANTS && (int)BINDINGS <= (int)PASS_MOST_BINDINGS, "");

static size_t pixel_size(const struct dispatcher *dispatcher)
{
    return CHANNELS * (dispatcher->value_type == VALUE_DOUBLE ? sizeof(double) : sizeof(float));
}

static enum status create_picture(struct dispatcher *dispatcher)
{
    VkDeviceSize size = dispatcher->size.tile_pixels * pixel_size(dispatcher);
    enum status status =
        vulkan_buffer_create(dispatcher->context, "tile of the picture", size,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                             BUFFER_DEVICE, &dispatcher->picture);
    if (status == STATUS_DONE && !dispatcher->picture.mapped)
        status =
            vulkan_buffer_create(dispatcher->context, "tile for the host", size,
                                 VK_BUFFER_USAGE_TRANSFER_DST_BIT, BUFFER_READBACK, &dispatcher->staging);
    dispatcher->values = dispatcher->staging.buffer ? dispatcher->staging.mapped : dispatcher->picture.mapped;
    return status;
}

static enum status create_saved(struct dispatcher *dispatcher)
{
    const VkDeviceSize pixels = dispatcher->size.tile_pixels;
    enum status status =
        vulkan_buffer_create(dispatcher->context, "saved pixels", pixels * SAVED_PIXEL_BYTES,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BUFFER_DEVICE, &dispatcher->saved_pixels);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(
            dispatcher->context, "saved stacks", pixels * dispatcher->size.stack_room * SAVED_PATH_BYTES,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BUFFER_DEVICE, &dispatcher->saved_stacks);
    return status;
}

static enum status create_events(struct dispatcher *dispatcher, uint32_t room)
{
    size_t value_size = pixel_size(dispatcher) / CHANNELS;
    enum status status =
        vulkan_buffer_create(dispatcher->context, "events",
                             sizeof(struct event_block) +
                                 (sizeof(struct EventHead) + EVENT_VALUES * value_size) * (VkDeviceSize)room,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BUFFER_READBACK, &dispatcher->events);
    if (status == STATUS_DONE)
        *(struct event_block *)dispatcher->events.mapped = (struct event_block){.room = room};
    return status;
}

static enum status create_pass(struct dispatcher *dispatcher, const struct dispatcher_info *info)
{
    /* the buffers that the pipeline does not use need something in their places */
    const VkBuffer picture = dispatcher->picture.buffer;
    const VkBuffer buffers[BINDINGS] = {
        [PICTURE] = picture,
        [SAVED_PIXELS] = info->size.stack_room ? dispatcher->saved_pixels.buffer : picture,
        [SAVED_STACKS] = info->size.stack_room ? dispatcher->saved_stacks.buffer : picture,
        [EVENTS] = dispatcher->events.buffer,
    };
    struct pass_binding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; ++i) {
        bindings[i].type = is_storage_buffer(i, info->scene_in_storage) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                        : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        bindings[i].memory = i < SCENE_BINDINGS ? info->scene->parts[i]
                                                : (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    }
    struct pass_constant constants[CONSTANTS];
    for (uint32_t i = 0; i < CONSTANTS; ++i)
        constants[i] = (struct pass_constant){i, ((const uint32_t *)&info->constants)[i]};
    double start = clock_ms();
    enum status status = vulkan_pass_create(dispatcher->context,
                                            &(struct pass_info){
                                                .name = "whitted.comp",
                                                .code = info->code,
                                                .constants = constants,
                                                .constant_count = CONSTANTS,
                                                .bindings = bindings,
                                                .binding_count = info->event_room > 0 ? BINDINGS : EVENTS,
                                                .push_constant_size = sizeof(struct portion),
                                            },
                                            &dispatcher->pass);
    log_info("pipeline built in %.1f ms", clock_ms() - start);
    return status;
}

enum status dispatcher_create(struct vulkan_context *context, const struct dispatcher_info *info,
                              struct dispatcher *dispatcher)
{
    const int output = info->constants.output;
    *dispatcher = (struct dispatcher){
        .context = context,
        .size = info->size,
        .value_type = output == OUTPUT_RAYS || output == OUTPUT_SIGNATURE ? VALUE_UINT32
                      : info->double_precision                            ? VALUE_DOUBLE
                                                                          : VALUE_FLOAT,
    };
    enum status status = create_picture(dispatcher);
    if (status == STATUS_DONE && info->size.stack_room > 0)
        status = create_saved(dispatcher);
    if (status == STATUS_DONE && info->event_room > 0)
        status = create_events(dispatcher, info->event_room);
    if (status == STATUS_DONE)
        status = create_pass(dispatcher, info);
    if (status == STATUS_DONE)
        status = vulkan_command_create(context, &dispatcher->command);
    if (status != STATUS_DONE)
        dispatcher_destroy(dispatcher);
    return status;
}

void dispatcher_destroy(struct dispatcher *dispatcher)
{
    struct vulkan_context *context = dispatcher->context;
    if (!context)
        return;
    vulkan_command_destroy(&dispatcher->command);
    vulkan_pass_destroy(&dispatcher->pass);
    vulkan_buffer_destroy(context, &dispatcher->events);
    vulkan_buffer_destroy(context, &dispatcher->saved_stacks);
    vulkan_buffer_destroy(context, &dispatcher->saved_pixels);
    vulkan_buffer_destroy(context, &dispatcher->staging);
    vulkan_buffer_destroy(context, &dispatcher->picture);
    *dispatcher = (struct dispatcher){0};
}

enum status dispatcher_run(struct dispatcher *dispatcher, const struct portion *portion, double *dispatch_ms)
{
    struct vulkan_command *command = &dispatcher->command;
    const struct group_shape *shape = &dispatcher->size.shape;
    const unsigned group_rows = shape->height * shape->rows;
    char label[96];
    double device_ms = 0;
    snprintf(label, sizeof label, "tile of %ux%u at %u, %u, samples %u to %u", portion->tile_width,
             portion->tile_height, portion->tile_x, portion->tile_y, portion->first_sample,
             portion->end_sample);
    enum status status = vulkan_command_begin(command, label);
    if (status != STATUS_DONE)
        return status;
    vulkan_pass_record(&dispatcher->pass, command, portion,
                       (portion->tile_width + shape->width - 1) / shape->width,
                       (portion->tile_height + group_rows - 1) / group_rows);
    if (dispatcher->staging.buffer) {
        vulkan_record_barrier(command->buffer, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        vkCmdCopyBuffer(
            command->buffer, dispatcher->picture.buffer, dispatcher->staging.buffer, 1,
            &(VkBufferCopy){
                .size = (VkDeviceSize)portion->tile_width * portion->tile_height * pixel_size(dispatcher),
            });
    }
    status = vulkan_command_submit(command);
    if (status == STATUS_DONE)
        status = vulkan_command_wait(command, &device_ms);
    *dispatch_ms += device_ms;
    return status;
}

double dispatcher_mark(const struct dispatcher *dispatcher, size_t pixels)
{
    const float *floats = dispatcher->values;
    const double *doubles = dispatcher->values;
    const int32_t *integers = dispatcher->values;
    double mark = 0;
    for (size_t i = 0; i < pixels * CHANNELS; i += CHANNELS) {
        double value = dispatcher->value_type == VALUE_DOUBLE   ? doubles[i]
                       : dispatcher->value_type == VALUE_UINT32 ? integers[i]
                                                                : (double)floats[i];
        mark = value < mark ? value : mark;
    }
    return mark;
}
