#include "tracer/dispatch.h"

#include "base/clock.h"

enum { CONSTANTS = sizeof(struct specialization) / sizeof(uint32_t) };
_Static_assert((int)CONSTANTS <= (int)PASS_MOST_CONSTANTS && (int)BINDINGS <= (int)PASS_MOST_BINDINGS, "");

static size_t value_size(const struct tracer_options *options)
{
    return options->double_precision ? sizeof(double) : sizeof(float);
}

static size_t pixel_size(const struct dispatcher *dispatcher)
{
    return CHANNELS * (dispatcher->value_type == VALUE_DOUBLE ? sizeof(double) : sizeof(float));
}

struct specialization dispatcher_specialization(const struct dispatcher *dispatcher,
                                                const struct packed_scene *scene)
{
    struct specialization constants = specialize(scene, &dispatcher->size, &dispatcher->options);
    constants.corrected_division = !dispatcher->context->arithmetic.division_exact;
    return constants;
}

static enum status create_pass(struct dispatcher *dispatcher)
{
    const struct shader_choice choice = dispatcher->choice;
    const struct tracer_options *options = &dispatcher->options;
    const struct specialization specialization = dispatcher_specialization(dispatcher, dispatcher->scene);
    struct pass_constant constants[CONSTANTS];
    for (uint32_t i = 0; i < CONSTANTS; ++i)
        constants[i] = (struct pass_constant){i, ((const uint32_t *)&specialization)[i]};
    VkDescriptorType bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; ++i)
        bindings[i] = binding_type(i, choice.scene_in_storage);
    double start = clock_ms();
    enum status status = vulkan_pass_create(
        dispatcher->context,
        &(struct pass_info){
            .name = "whitted.comp",
            .code = options->code.words ? options->code : whitted_spirv(choice, is_plain(&specialization)),
            .fast = options->fast,
            .constants = constants,
            .constant_count = CONSTANTS,
            .bindings = bindings,
            .binding_count = options->event_room > 0 ? BINDINGS : EVENTS,
            .push_constant_size = sizeof(struct portion),
        },
        &dispatcher->pass);
    log_info("pipeline built in %.1f ms", clock_ms() - start);
    return status;
}

enum status dispatcher_create(struct dispatcher *dispatcher)
{
    const struct tracer_options *options = &dispatcher->options;
    dispatcher->size = dispatch_size_choose(dispatcher->context, dispatcher->scene, value_size(options));
    dispatcher->value_type = options->counts             ? VALUE_UINT32
                             : options->double_precision ? VALUE_DOUBLE
                                                         : VALUE_FLOAT;
    enum status status = scene_buffer_create(dispatcher->context, dispatcher->scene,
                                             dispatcher->choice.scene_in_storage, &dispatcher->scene_buffer);
    return status == STATUS_DONE ? create_pass(dispatcher) : status;
}

void dispatcher_destroy(struct dispatcher *dispatcher)
{
    vulkan_pass_destroy(&dispatcher->pass);
    scene_buffer_destroy(dispatcher->context, &dispatcher->scene_buffer);
    *dispatcher = (struct dispatcher){0};
}

static uint32_t groups_down(const struct dispatch_size *size, uint32_t height)
{
    return (height + size->group_height - 1) / size->group_height;
}

/* The threads among which rows of groups are dealt out: so many that an equal number each has few in excess.
 */
static uint32_t dealt_threads(const struct dispatch_size *size, uint32_t groups)
{
    uint32_t threads = size->threads;
    while (threads > 1 && (threads - groups % threads) % threads > most_excess(groups))
        --threads;
    return threads;
}

static enum status create_buffers(const struct dispatcher *dispatcher, uint32_t tile_width,
                                  uint32_t tile_height, struct dispatch_frame *frame)
{
    static const struct {
        const char *name;
        enum buffer_memory memory;
    } kinds[BINDINGS] = {
        [PICTURE] = {"tile of the picture", BUFFER_DEVICE},
        [SAVED_REALS] = {"saved real numbers", BUFFER_DEVICE},
        [SAVED_WORDS] = {"saved words", BUFFER_DEVICE},
        [OUTCOME] = {"outcome", BUFFER_READBACK},
        [EVENTS] = {"events", BUFFER_READBACK},
    };
    const struct dispatch_size *size = &dispatcher->size;
    const uint32_t groups = groups_down(size, tile_height);
    const VkDeviceSize invocations = (VkDeviceSize)groups_across(size, tile_width) * size->group_width *
                                     (groups + most_excess(groups)) * size->group_height;
    const VkDeviceSize doubled = value_size(&dispatcher->options) / sizeof(float);
    const VkDeviceSize picture_bytes = (VkDeviceSize)tile_width * tile_height * pixel_size(dispatcher);
    const size_t event_bytes = sizeof(struct EventHead) + EVENT_VALUES * value_size(&dispatcher->options);
    const VkDeviceSize bytes[BINDINGS] = {
        [PICTURE] = picture_bytes,
        [SAVED_REALS] = invocations * size->saved_reals * SAVED_REAL_BYTES * doubled,
        [SAVED_WORDS] = invocations * size->saved_words * sizeof(uint32_t),
        [OUTCOME] = size->resumable ? sizeof(uint32_t) : 0,
        [EVENTS] = dispatcher->options.event_room > 0
                       ? sizeof(struct event_block) + dispatcher->options.event_room * event_bytes
                       : 0,
    };
    enum status status = STATUS_DONE;
    for (int i = PICTURE; i < BINDINGS && status == STATUS_DONE; ++i)
        if (bytes[i] > 0)
            status = vulkan_buffer_create(dispatcher->context, kinds[i].name, bytes[i], kinds[i].memory,
                                          &frame->buffers[i]);
    if (status == STATUS_DONE && !frame->buffers[PICTURE].mapped)
        status = vulkan_buffer_create(dispatcher->context, "tile for the host", picture_bytes,
                                      BUFFER_READBACK, &frame->staging);
    if (status == STATUS_DONE && dispatcher->options.event_room > 0)
        *(struct event_block *)frame->buffers[EVENTS].mapped =
            (struct event_block){.room = dispatcher->options.event_room};
    frame->values = frame->staging.buffer ? frame->staging.mapped : frame->buffers[PICTURE].mapped;
    return status;
}

enum status dispatch_frame_create(const struct dispatcher *dispatcher, uint32_t tile_width,
                                  uint32_t tile_height, struct dispatch_frame *frame)
{
    *frame = (struct dispatch_frame){0};
    enum status status = create_buffers(dispatcher, tile_width, tile_height, frame);
    VkDescriptorBufferInfo memory[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; ++i) {
        /* the buffers that the pipeline does not use need something in their places */
        const struct vulkan_buffer *buffer = &frame->buffers[frame->buffers[i].buffer ? i : PICTURE];
        memory[i] = i < SCENE_BINDINGS ? dispatcher->scene_buffer.parts[i]
                                       : (VkDescriptorBufferInfo){buffer->buffer, 0, VK_WHOLE_SIZE};
    }
    if (status == STATUS_DONE)
        status = pass_frame_create(&dispatcher->pass, memory, dispatcher->scene_buffer.texels, &frame->frame);
    if (status != STATUS_DONE)
        dispatch_frame_destroy(dispatcher, frame);
    return status;
}

void dispatch_frame_destroy(const struct dispatcher *dispatcher, struct dispatch_frame *frame)
{
    pass_frame_destroy(&frame->frame);
    for (int i = PICTURE; i < BINDINGS; ++i)
        if (frame->buffers[i].buffer)
            vulkan_buffer_destroy(dispatcher->context, &frame->buffers[i]);
    if (frame->staging.buffer)
        vulkan_buffer_destroy(dispatcher->context, &frame->staging);
    *frame = (struct dispatch_frame){0};
}

/* Adds the copy to the staging buffer. */
static void copy_to_staging(const struct dispatcher *dispatcher, const struct dispatch_frame *frame,
                            struct pass_dispatch *dispatch)
{
    const struct portion *portion = &frame->portion;
    dispatch->copy_from = frame->buffers[PICTURE].buffer;
    dispatch->copy_to = frame->staging.buffer;
    dispatch->copy_size =
        (VkDeviceSize)portion->tile_width * portion->tile_height * pixel_size(dispatcher);
}

enum status dispatch_frame_start(const struct dispatcher *dispatcher, struct dispatch_frame *frame)
{
    const struct dispatch_size *size = &dispatcher->size;
    const uint32_t groups = groups_down(size, frame->portion.tile_height),
                   threads = dealt_threads(size, groups);
    frame->portion.threads = threads;
    struct pass_dispatch dispatch = {
        .push_constants = &frame->portion,
        .groups_x = groups_across(size, frame->portion.tile_width),
        .groups_y = (groups + threads - 1) / threads * threads,
    };
    if (size->resumable)
        *(uint32_t *)frame->buffers[OUTCOME].mapped = 0;
    else if (frame->staging.buffer)
        copy_to_staging(dispatcher, frame, &dispatch);
    enum status status = pass_frame_submit(&frame->frame, &dispatch);
    frame->under_way = status == STATUS_DONE;
    return status;
}

enum status dispatch_frame_wait(const struct dispatcher *dispatcher, struct dispatch_frame *frame,
                                double *device_ms, uint32_t *unfinished)
{
    enum status status = pass_frame_wait(&frame->frame, device_ms);
    frame->under_way = false;
    *unfinished = dispatcher->size.resumable ? *(const uint32_t *)frame->buffers[OUTCOME].mapped : 0;
    return status;
}

enum status dispatch_frame_fetch(const struct dispatcher *dispatcher, struct dispatch_frame *frame)
{
    struct pass_dispatch copy = {0};
    if (!frame->staging.buffer || !dispatcher->size.resumable)
        return STATUS_DONE;
    copy_to_staging(dispatcher, frame, &copy);
    enum status status = pass_frame_submit(&frame->frame, &copy);
    return status == STATUS_DONE ? pass_frame_wait(&frame->frame, NULL) : status;
}
