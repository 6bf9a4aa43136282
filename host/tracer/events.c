#include "tracer/tracer_private.h"

/* As EventBlock in shaders/events.glsl. */
struct event_block {
    uint32_t count, room, unused[2];
};

enum status tracer_create_events(struct tracer *tracer)
{
    const uint32_t room = tracer->options.event_room;
    if (room == 0)
        return STATUS_DONE;
    size_t value_size = tracer->double_precision ? sizeof(double) : sizeof(float);
    VkDeviceSize size = sizeof(struct event_block) +
                        (sizeof(struct EventHead) + EVENT_VALUES * value_size) * (VkDeviceSize)room;
    const VkMemoryPropertyFlags visible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    enum status status = vulkan_buffer_create(
        tracer->context, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        (VkMemoryPropertyFlags[]){visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, visible, 0}, &tracer->events);
    if (status == STATUS_DONE && !tracer->events.mapped) {
        log_error("the device has no memory that the host can see");
        status = STATUS_UNABLE;
    }
    if (status == STATUS_DONE)
        *(struct event_block *)tracer->events.mapped = (struct event_block){.room = room};
    tracer->bindings[EVENTS] =
        (VkDescriptorBufferInfo){.buffer = tracer->events.buffer, .range = VK_WHOLE_SIZE};
    return status;
}

uint32_t tracer_events(const struct tracer *tracer, const void **events)
{
    const struct event_block *block = tracer->events.mapped;
    *events = block + 1;
    return block->count;
}
