#include "tracer/dispatch.h"

#include "base/clock.h"

enum { CONSTANTS = sizeof(struct specialization) / sizeof(uint32_t) };
_Static_assert((int)CONSTANTS <= (int)PASS_MOST_CONSTANTS && (int)BINDINGS <= (int)PASS_MOST_BINDINGS, "");

static size_t pixel_size(const struct dispatcher *dispatcher)
{
    return CHANNELS * (dispatcher->value_type == VALUE_DOUBLE ? sizeof(double) : sizeof(float));
}

static enum status create_buffers(struct dispatcher *dispatcher, uint32_t event_room)
{
    static const char *const names[BINDINGS] = {
        [PICTURE] = "tile of the picture",
        [SAVED_PIXELS] = "saved pixels",
        [SAVED_STACKS] = "saved stacks",
        [EVENTS] = "events",
    };
    const struct dispatch_size *size = &dispatcher->size;
    const VkDeviceSize pixels = size->tile_pixels, picture_bytes = pixels * pixel_size(dispatcher);
    const size_t event_bytes = sizeof(struct EventHead) + EVENT_VALUES * pixel_size(dispatcher) / CHANNELS;
    const VkDeviceSize bytes[BINDINGS] = {
        [PICTURE] = picture_bytes,
        [SAVED_PIXELS] = size->stack_room > 0 ? pixels * SAVED_PIXEL_BYTES : 0,
        [SAVED_STACKS] = pixels * size->stack_room * SAVED_PATH_BYTES,
        [EVENTS] = event_room > 0 ? sizeof(struct event_block) + event_room * event_bytes : 0,
    };
    struct vulkan_buffer *buffers = dispatcher->buffers, *staging = &dispatcher->staging;
    enum status status = STATUS_DONE;
    for (int i = PICTURE; i < BINDINGS && status == STATUS_DONE; ++i)
        if (bytes[i] > 0)
            status = vulkan_buffer_create(dispatcher->context, names[i], bytes[i],
                                          i == EVENTS ? BUFFER_READBACK : BUFFER_DEVICE, &buffers[i]);
    if (status == STATUS_DONE && !buffers[PICTURE].mapped)
        status = vulkan_buffer_create(dispatcher->context, "tile for the host", picture_bytes,
                                      BUFFER_READBACK, staging);
    if (status == STATUS_DONE && event_room > 0)
        *(struct event_block *)buffers[EVENTS].mapped = (struct event_block){.room = event_room};
    dispatcher->values = staging->buffer ? staging->mapped : buffers[PICTURE].mapped;
    return status;
}

static enum status create_pass(struct dispatcher *dispatcher, const struct dispatcher_info *info)
{
    const struct shader_choice choice = info->choice;
    const struct specialization specialization =
        specialize(info->context, info->scene, &dispatcher->size, info->options.output);
    struct pass_constant constants[CONSTANTS];
    for (uint32_t i = 0; i < CONSTANTS; ++i)
        constants[i] = (struct pass_constant){i, ((const uint32_t *)&specialization)[i]};
    struct pass_binding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; ++i) {
        /* the buffers that the pipeline does not use need something in their places */
        const struct vulkan_buffer *buffer =
            &dispatcher->buffers[dispatcher->buffers[i].buffer ? i : PICTURE];
        bindings[i].type = is_storage_buffer(i, choice.scene_in_storage) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                         : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        bindings[i].memory = i < SCENE_BINDINGS ? info->scene_buffer.parts[i]
                                                : (VkDescriptorBufferInfo){buffer->buffer, 0, VK_WHOLE_SIZE};
    }
    double start = clock_ms();
    enum status status = vulkan_pass_create(
        dispatcher->context,
        &(struct pass_info){
            .name = "whitted.comp",
            .code = info->options.code.words ? info->options.code
                                             : whitted_spirv(choice.variant, choice.scene_in_storage),
            .constants = constants,
            .constant_count = CONSTANTS,
            .bindings = bindings,
            .binding_count = info->options.event_room > 0 ? BINDINGS : EVENTS,
            .push_constant_size = sizeof(struct portion),
        },
        &dispatcher->pass);
    log_info("pipeline built in %.1f ms", clock_ms() - start);
    return status;
}

enum status dispatcher_create(const struct dispatcher_info *info, struct dispatch_size size,
                              struct dispatcher *dispatcher)
{
    const int output = info->options.output;
    *dispatcher = (struct dispatcher){
        .context = info->context,
        .size = size,
        .value_type = output == OUTPUT_RAYS || output == OUTPUT_SIGNATURE ? VALUE_UINT32
                      : info->options.double_precision                    ? VALUE_DOUBLE
                                                                          : VALUE_FLOAT,
    };
    enum status status = create_buffers(dispatcher, info->options.event_room);
    if (status == STATUS_DONE)
        status = create_pass(dispatcher, info);
    if (status != STATUS_DONE)
        dispatcher_destroy(dispatcher);
    return status;
}

void dispatcher_destroy(struct dispatcher *dispatcher)
{
    if (!dispatcher->context)
        return;
    vulkan_pass_destroy(&dispatcher->pass);
    for (int i = PICTURE; i < BINDINGS; ++i)
        vulkan_buffer_destroy(dispatcher->context, &dispatcher->buffers[i]);
    vulkan_buffer_destroy(dispatcher->context, &dispatcher->staging);
    *dispatcher = (struct dispatcher){0};
}

enum status dispatcher_run(struct dispatcher *dispatcher, const struct portion *portion, double *dispatch_ms)
{
    const struct dispatch_size *size = &dispatcher->size;
    const unsigned group_rows = size->group_height * size->rows;
    const size_t pixels = (size_t)portion->tile_width * portion->tile_height;
    double device_ms = 0;
    enum status status =
        vulkan_pass_run(&dispatcher->pass,
                        &(struct pass_dispatch){
                            .push_constants = portion,
                            .groups_x = (portion->tile_width + size->group_width - 1) / size->group_width,
                            .groups_y = (portion->tile_height + group_rows - 1) / group_rows,
                            .copy_from = dispatcher->buffers[PICTURE].buffer,
                            .copy_to = dispatcher->staging.buffer,
                            .copy_size = pixels * pixel_size(dispatcher),
                        },
                        &device_ms);
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
