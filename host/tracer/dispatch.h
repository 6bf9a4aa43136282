#ifndef VKWHITTED_TRACER_DISPATCH_H
#define VKWHITTED_TRACER_DISPATCH_H

#include "tracer/dispatch_size.h"
#include "tracer/scene_buffer.h"
#include "vulkan/pass.h"

enum { CHANNELS = 3 };

/* What the shader's three values of a pixel are: real numbers or, for the outputs that are counted, integers.
 */
enum value_type { VALUE_FLOAT, VALUE_DOUBLE, VALUE_UINT32 };

struct dispatcher_info {
    const struct scene_buffer *scene;
    bool scene_in_storage;
    struct spirv code;
    struct specialization constants;
    struct dispatch_size size;
    bool double_precision;
    uint32_t event_room; /* 0: the shader records no events */
};

/* Renders tiles of a picture with one pipeline, one at a time. */
struct dispatcher {
    struct vulkan_context *context;
    struct dispatch_size size;
    enum value_type value_type;
    const void *values; /* of the last tile, row by row, CHANNELS a pixel */
    struct vulkan_buffer picture;
    struct vulkan_buffer staging;                    /* only where the host cannot read `picture` well */
    struct vulkan_buffer saved_pixels, saved_stacks; /* only with size.stack_room */
    struct vulkan_buffer events;                     /* only with room for some */
    struct vulkan_pass pass;
    struct vulkan_command command;
};

/* A dispatch: samples of a tile. As TileBlock in whitted.comp. */
struct portion {
    uint32_t tile_x, tile_y, tile_width, tile_height, picture_width, picture_height; /* pixels */
    uint32_t first_sample, end_sample;
    uint32_t goes_on; /* with what the dispatch before has left of the sample */
};

/* What `events` begins with. As EventBlock in shaders/events.glsl. */
struct event_block {
    uint32_t count, room, unused[2];
};

/* Builds the pipeline and what it needs; the scene's buffer must outlive the dispatcher. On failure
 * (reported) *dispatcher is empty. */
enum status dispatcher_create(struct vulkan_context *context, const struct dispatcher_info *info,
                              struct dispatcher *dispatcher);

/* Destroys it, or nothing. */
void dispatcher_destroy(struct dispatcher *dispatcher);

/* Adds the portion to the tile's values, and the device's time to *dispatch_ms. Failures are reported. */
enum status dispatcher_run(struct dispatcher *dispatcher, const struct portion *portion, double *dispatch_ms);

/* The lowest of the first values of so many pixels: UNFINISHED or TOO_LONG of scene_layout.h, or something
 * lower where ended loops have left a pixel as it was in memory; 0 if all are done. */
double dispatcher_mark(const struct dispatcher *dispatcher, size_t pixels);

#endif
