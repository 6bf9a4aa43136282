#include "image/exr_input.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text_file.h"
#include "image/exr_error.h"

enum { LARGEST_TILE = 4096 }; /* pixels a side */

static enum status refuse(const struct exr_input *input)
{
    log_error("%s: cannot read EXR: %s", input->path, exr_error());
    return STATUS_REFUSED;
}

enum status exr_input_open(const char *path, struct exr_input *input)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = exr_error_keep;
    initializer.max_tile_width = initializer.max_tile_height = LARGEST_TILE;
    *input = (struct exr_input){.path = path};
    const int file = input_file_open(path, true);
    if (file < 0)
        return input_file_refuse(path);
    close(file);
    exr_error_clear();
    return exr_succeeded(exr_start_read(&input->context, path, &initializer)) ? STATUS_DONE : refuse(input);
}

void exr_input_close(struct exr_input *input)
{
    if (input->context)
        exr_finish(&input->context);
    free(input->values);
    *input = (struct exr_input){0};
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

/* Has the pipeline write the wanted channels to the values, from that column of the first row on. The others
 * are written behind them, all to the same place: the library's quick ways for 3 and 4 halves leave none out.
 */
static bool point_to_channels(struct exr_input *input, exr_decode_pipeline_t *pipeline, size_t column,
                              int rows)
{
    float *unwanted = input->values + (size_t)rows * input->width * (size_t)input->channel_count;
    int found = 0;
    for (int c = 0; c < pipeline->channel_count; ++c) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        channel->decode_to_ptr = (uint8_t *)unwanted;
        channel->user_data_type = channel->data_type;
        channel->user_bytes_per_element = channel->bytes_per_element;
        channel->user_pixel_stride = channel->bytes_per_element;
        channel->user_line_stride = (int32_t)input->width * channel->user_pixel_stride;
        for (int i = 0; i < input->channel_count; ++i)
            if (strcmp(channel->channel_name, input->channels[i]) == 0 && channel->x_samples == 1 &&
                channel->y_samples == 1) {
                channel->decode_to_ptr =
                    (uint8_t *)(input->values + column * (size_t)input->channel_count + i);
                channel->user_data_type = EXR_PIXEL_FLOAT;
                channel->user_bytes_per_element = sizeof(float);
                channel->user_pixel_stride = input->channel_count * (int32_t)sizeof(float);
                channel->user_line_stride = (int32_t)input->width * channel->user_pixel_stride;
                ++found;
            }
    }
    if (found < input->channel_count)
        exr_error_keep(input->context, EXR_ERR_INVALID_ARGUMENT, "it lacks a channel");
    return found == input->channel_count;
}

/* Makes room for so many rows, and for what is not wanted of them. */
static bool require_rows(struct exr_input *input, int rows)
{
    const size_t values = (size_t)rows * input->width * ((size_t)input->channel_count + 1);
    if (values <= input->room)
        return true;
    free(input->values);
    input->values = malloc(values * sizeof *input->values);
    input->room = input->values ? values : 0;
    return input->values;
}

/* Decodes a chunk to that column of the rows, for which there is room. */
static bool decode(struct exr_input *input, const exr_chunk_info_t *chunk, size_t column, int rows)
{
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    if (column + (size_t)chunk->width > input->width || chunk->height > rows) {
        exr_error_keep(input->context, EXR_ERR_BAD_CHUNK_LEADER, "a chunk reaches out of the picture");
        return false;
    }
    const bool decoded =
        exr_succeeded(exr_decoding_initialize(input->context, input->part, chunk, &pipeline)) &&
        point_to_channels(input, &pipeline, column, rows) &&
        exr_succeeded(exr_decoding_choose_default_routines(input->context, input->part, &pipeline)) &&
        exr_succeeded(exr_decoding_run(input->context, input->part, &pipeline));
    exr_decoding_destroy(input->context, &pipeline);
    return decoded;
}

static bool decode_scanlines(struct exr_input *input, int y)
{
    exr_chunk_info_t chunk;
    if (!exr_succeeded(exr_read_scanline_chunk_info(input->context, input->part, y, &chunk)) ||
        !require_rows(input, chunk.height) || !decode(input, &chunk, 0, chunk.height))
        return false;
    input->first = chunk.start_y;
    input->count = chunk.height;
    return true;
}

static bool decode_tiles(struct exr_input *input, int y, const exr_attr_box2i_t *window)
{
    uint32_t width, height;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    if (!exr_succeeded(
            exr_get_tile_descriptor(input->context, input->part, &width, &height, &levels, &rounding)))
        return false;
    const int row = (int)((int64_t)y - window->min.y) / (int)height;
    const int64_t first = window->min.y + (int64_t)row * height, left = (int64_t)window->max.y + 1 - first;
    const int rows = left < height ? (int)left : (int)height;
    bool decoded = require_rows(input, rows);
    for (int column = 0; decoded && (size_t)column * width < input->width; ++column) {
        exr_chunk_info_t chunk;
        decoded =
            exr_succeeded(exr_read_tile_chunk_info(input->context, input->part, column, row, 0, 0, &chunk)) &&
            decode(input, &chunk, (size_t)column * width, rows);
    }
    input->first = (int)first;
    input->count = decoded ? rows : 0;
    return decoded;
}

/* Decodes the chunk, or the row of tiles, that holds row y. */
static bool decode_rows(struct exr_input *input, int y)
{
    exr_storage_t storage;
    exr_attr_box2i_t window;
    input->count = 0;
    if (!exr_succeeded(exr_get_storage(input->context, input->part, &storage)) ||
        !exr_succeeded(exr_get_data_window(input->context, input->part, &window)))
        return false;
    input->width = (size_t)((int64_t)window.max.x - window.min.x + 1);
    if (storage == EXR_STORAGE_SCANLINE)
        return decode_scanlines(input, y);
    if (storage == EXR_STORAGE_TILED)
        return decode_tiles(input, y, &window);
    exr_error_keep(input->context, EXR_ERR_INVALID_ARGUMENT, "expected a flat picture, is a deep one");
    return false;
}

enum status exr_input_read(struct exr_input *input, int part, int y, const char *const *channels,
                           int channel_count, const float **row)
{
    exr_error_clear();
    if (part != input->part || channels != input->channels)
        input->count = 0;
    input->part = part;
    input->channels = channels;
    input->channel_count = channel_count;
    const bool there = y >= input->first && y - input->first < input->count;
    if (!there && !decode_rows(input, y))
        return refuse(input);
    *row = input->values + (size_t)(y - input->first) * input->width * (size_t)channel_count;
    return STATUS_DONE;
}
