#include "image/exr_input.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text_file.h"
#include "image/exr_error.h"

struct exr_input {
    const char *path;
    exr_context_t context;
    exr_decode_pipeline_t pipeline;
    float *values;               /* of the chunk that was read last */
    size_t room;                 /* values */
    const char *const *channels; /* that it holds */
    int part;                    /* of the pipeline; -1: there is none */
    int first, count, width;     /* of the chunk; count 0: there is none */
};

static enum status refuse(const struct exr_input *input)
{
    log_error("%s: cannot read EXR: %s", input->path, exr_error());
    return STATUS_REFUSED;
}

enum status exr_input_open(const char *path, struct exr_input **input)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = exr_error_keep;
    *input = NULL;
    off_t size;
    const int file = input_file_open(path, true, &size);
    if (file < 0)
        return input_file_refuse(path);
    close(file);
    struct exr_input *opened = calloc(1, sizeof *opened);
    if (!opened) {
        log_error("%s: no memory to read it", path);
        return STATUS_UNABLE;
    }
    *opened = (struct exr_input){.path = path, .part = -1};
    exr_error_clear();
    if (exr_succeeded(exr_start_read(&opened->context, path, &initializer))) {
        *input = opened;
        return STATUS_DONE;
    }
    enum status status = refuse(opened);
    free(opened);
    return status;
}

static void end_part(struct exr_input *input)
{
    if (input->part >= 0)
        exr_decoding_destroy(input->context, &input->pipeline);
    input->pipeline = (exr_decode_pipeline_t)EXR_DECODE_PIPELINE_INITIALIZER;
    input->part = -1;
    input->count = 0;
}

void exr_input_close(struct exr_input **pointer)
{
    struct exr_input *input = *pointer;
    *pointer = NULL;
    if (!input)
        return;
    end_part(input);
    exr_finish(&input->context);
    free(input->values);
    free(input);
}

int exr_input_parts(const struct exr_input *input)
{
    int count = 0;
    return exr_succeeded(exr_get_count(input->context, &count)) ? count : 0;
}

static bool read_box(const exr_attr_box2i_t *box, struct window *window)
{
    enum { MOST = 65536 };
    if (box->min.x < 0 || box->min.y < 0 || box->max.x < box->min.x || box->max.y < box->min.y ||
        box->max.x >= MOST || box->max.y >= MOST)
        return false;
    *window =
        (struct window){(unsigned)box->min.x, (unsigned)box->min.y, (unsigned)(box->max.x - box->min.x) + 1,
                        (unsigned)(box->max.y - box->min.y) + 1};
    return true;
}

bool exr_input_windows(const struct exr_input *input, int part, struct window *data, struct window *display)
{
    exr_attr_box2i_t data_box, display_box;
    return exr_succeeded(exr_get_data_window(input->context, part, &data_box)) &&
           exr_succeeded(exr_get_display_window(input->context, part, &display_box)) &&
           read_box(&data_box, data) && read_box(&display_box, display);
}

const char *exr_input_text(const struct exr_input *input, const char *name)
{
    const exr_attribute_t *attribute;
    return exr_get_attribute_by_name(input->context, 0, name, &attribute) == EXR_ERR_SUCCESS &&
                   attribute->type == EXR_ATTR_STRING
               ? attribute->string->str
               : NULL;
}

int exr_input_number(const struct exr_input *input, const char *name)
{
    const exr_attribute_t *attribute;
    return exr_get_attribute_by_name(input->context, 0, name, &attribute) == EXR_ERR_SUCCESS &&
                   attribute->type == EXR_ATTR_INT
               ? attribute->i
               : 0;
}

/* Has the pipeline write the named channels to the buffer, and leave out the others. */
static bool point_to_channels(struct exr_input *input, const char *const *channels, int channel_count)
{
    int found = 0;
    for (int c = 0; c < input->pipeline.channel_count; ++c) {
        exr_coding_channel_info_t *channel = &input->pipeline.channels[c];
        channel->decode_to_ptr = NULL;
        for (int i = 0; i < channel_count; ++i)
            if (strcmp(channel->channel_name, channels[i]) == 0 && channel->x_samples == 1 &&
                channel->y_samples == 1) {
                channel->decode_to_ptr = (uint8_t *)(input->values + i);
                channel->user_data_type = EXR_PIXEL_FLOAT;
                channel->user_bytes_per_element = sizeof(float);
                channel->user_pixel_stride = channel_count * (int32_t)sizeof(float);
                channel->user_line_stride = input->width * channel->user_pixel_stride;
                ++found;
            }
    }
    if (found < channel_count)
        exr_error_keep(input->context, EXR_ERR_INVALID_ARGUMENT, "it lacks a channel");
    return found == channel_count;
}

static bool require_room(struct exr_input *input, size_t values)
{
    if (values <= input->room)
        return true;
    free(input->values);
    input->values = malloc(values * sizeof *input->values);
    input->room = input->values ? values : 0;
    return input->values;
}

/* Reads the chunk that holds the row. */
static bool read_chunk(struct exr_input *input, int part, int y, const char *const *channels,
                       int channel_count)
{
    exr_chunk_info_t chunk;
    exr_storage_t storage;
    if (!exr_succeeded(exr_get_storage(input->context, part, &storage)))
        return false;
    if (storage != EXR_STORAGE_SCANLINE) {
        exr_error_keep(input->context, EXR_ERR_SCAN_TILE_MIXEDAPI, "it is not stored in scan lines");
        return false;
    }
    if (!exr_succeeded(exr_read_scanline_chunk_info(input->context, part, y, &chunk)) ||
        !require_room(input, (size_t)chunk.width * (size_t)chunk.height * (size_t)channel_count))
        return false;
    const bool goes_on = part == input->part && channels == input->channels;
    if (!goes_on)
        end_part(input);
    input->count = 0;
    if (!exr_succeeded(goes_on ? exr_decoding_update(input->context, part, &chunk, &input->pipeline)
                               : exr_decoding_initialize(input->context, part, &chunk, &input->pipeline)))
        return false;
    input->part = part;
    input->width = chunk.width;
    input->channels = channels;
    if (!point_to_channels(input, channels, channel_count) ||
        !(goes_on ||
          exr_succeeded(exr_decoding_choose_default_routines(input->context, part, &input->pipeline))) ||
        !exr_succeeded(exr_decoding_run(input->context, part, &input->pipeline)))
        return false;
    input->first = chunk.start_y;
    input->count = chunk.height;
    return true;
}

enum status exr_input_read(struct exr_input *input, int part, unsigned y, const char *const *channels,
                           int channel_count, const float **row)
{
    const bool there = part == input->part && channels == input->channels && (int)y >= input->first &&
                       (int)y < input->first + input->count;
    exr_error_clear();
    if (!there && !read_chunk(input, part, (int)y, channels, channel_count))
        return refuse(input);
    *row = input->values + (size_t)((int)y - input->first) * (size_t)input->width * (size_t)channel_count;
    return STATUS_DONE;
}
