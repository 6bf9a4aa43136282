#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/exr_error.h"
#include "image/read_formats.h"

enum { LARGEST_TILE = 4096 }; /* pixels a side */

struct exr_input {
    const struct read_input *input;
    struct read_image *picture;
    exr_context_t context;
    exr_decode_pipeline_t pipeline;
    exr_attr_box2i_t window; /* the data's */
    const char *channels[3]; /* the names of those that make the picture's; three times the same for grey */
    bool is_half[3];
    bool reported; /* why the file is refused */
};

static int64_t on_read(exr_const_context_t context, void *user_data, void *bytes, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t report_error)
{
    (void)context;
    (void)report_error;
    const struct read_input *input = ((struct exr_input *)user_data)->input;
    const uint64_t left = offset < input->size ? input->size - offset : 0;
    const uint64_t read = size < left ? size : left; /* the library sees that it is less than it needs */
    if (read > 0)
        memcpy(bytes, input->bytes + offset, read);
    return (int64_t)read;
}

static int64_t on_size(exr_const_context_t context, void *user_data)
{
    (void)context;
    return (int64_t)((struct exr_input *)user_data)->input->size;
}

/* Keeps why the file is refused; false. */
__attribute__((format(printf, 1, 2))) static bool refuse(const char *format, ...)
{
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    exr_error_keep(NULL, EXR_ERR_SUCCESS, message);
    return false;
}

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; ++i)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return &list->entries[i];
    return NULL;
}

static bool choose_channels(struct exr_input *file)
{
    const exr_attr_chlist_t *list;
    if (!exr_succeeded(exr_get_channels(file->context, 0, &list)))
        return false;
    const bool grey = !find_channel(list, "R") && !find_channel(list, "BY");
    static const char *const colors[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const exr_attr_chlist_entry_t *channel = find_channel(list, grey ? "Y" : colors[c]);
        if (!channel)
            return refuse("expected the channels R, G and B or Y, has no %s", grey ? "Y" : colors[c]);
        if (channel->pixel_type == EXR_PIXEL_UINT || channel->x_sampling != 1 || channel->y_sampling != 1)
            return refuse("channel %s: expected half or float for each pixel", channel->name.str);
        file->channels[c] = channel->name.str;
        file->is_half[c] = channel->pixel_type == EXR_PIXEL_HALF;
    }
    return true;
}

static bool check_windows(struct exr_input *file)
{
    const struct image_wanted *wanted = file->input->wanted;
    exr_attr_box2i_t display;
    if (!exr_succeeded(exr_get_data_window(file->context, 0, &file->window)) ||
        !exr_succeeded(exr_get_display_window(file->context, 0, &display)))
        return false;
    const exr_attr_v2i_t first = file->window.min, last = file->window.max;
    if (memcmp(&file->window, &display, sizeof display) == 0 ||
        ((int64_t)first.x - display.min.x == wanted->window.x &&
         (int64_t)first.y - display.min.y == wanted->window.y))
        return true;
    return refuse(
        "its data window (%d, %d)..(%d, %d) is not its display window (%d, %d)..(%d, %d), and not the part "
        "that is judged",
        first.x, first.y, last.x, last.y, display.min.x, display.min.y, display.max.x, display.max.y);
}

static bool check_storage(struct exr_input *file, bool *tiled)
{
    exr_storage_t storage;
    exr_compression_t compression;
    if (!exr_succeeded(exr_get_storage(file->context, 0, &storage)) ||
        !exr_succeeded(exr_get_compression(file->context, 0, &compression)))
        return false;
    *tiled = storage == EXR_STORAGE_TILED;
    if (!*tiled && storage != EXR_STORAGE_SCANLINE)
        return refuse("expected a flat picture, is a deep one");
    if (compression > EXR_COMPRESSION_PIZ)
        return refuse("compressed with loss: by how much its values are off is not known");
    return true;
}

/* Decodes the chunk, whose first pixel is in that column and row of the picture. */
static bool read_chunk(struct exr_input *file, const exr_chunk_info_t *chunk, int64_t x, int64_t y)
{
    exr_decode_pipeline_t *pipeline = &file->pipeline;
    const struct read_image *picture = file->picture;
    const bool first = !pipeline->channels;
    if (x < 0 || y < 0 || x + chunk->width > picture->width || y + chunk->height > picture->height)
        return refuse("a chunk reaches out of the picture");
    if (!exr_succeeded(first ? exr_decoding_initialize(file->context, 0, chunk, pipeline)
                             : exr_decoding_update(file->context, 0, chunk, pipeline)))
        return false;
    const size_t row = 3 * (size_t)picture->width;
    for (int i = 0; i < pipeline->channel_count; ++i) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        channel->decode_to_ptr = NULL;
        for (size_t c = 3; c-- > 0;)
            if (strcmp(channel->channel_name, file->channels[c]) == 0)
                channel->decode_to_ptr = (uint8_t *)&picture->rgb[(size_t)y * row + 3 * (size_t)x + c].low;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = 3 * sizeof *picture->rgb;
        channel->user_line_stride = (int32_t)(row * sizeof *picture->rgb);
    }
    return (!first || exr_succeeded(exr_decoding_choose_default_routines(file->context, 0, pipeline))) &&
           exr_succeeded(exr_decoding_run(file->context, 0, pipeline));
}

static bool read_scanlines(struct exr_input *file)
{
    int32_t rows_per_chunk;
    exr_chunk_info_t chunk;
    bool read = exr_succeeded(exr_get_scanlines_per_chunk(file->context, 0, &rows_per_chunk));
    for (int64_t y = 0; read && y < file->picture->height; y += rows_per_chunk)
        read = exr_succeeded(
                   exr_read_scanline_chunk_info(file->context, 0, (int)(file->window.min.y + y), &chunk)) &&
               read_chunk(file, &chunk, 0, (int64_t)chunk.start_y - file->window.min.y);
    return read;
}

static bool read_tiles(struct exr_input *file)
{
    uint32_t width, height;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_chunk_info_t chunk;
    bool read = exr_succeeded(exr_get_tile_descriptor(file->context, 0, &width, &height, &levels, &rounding));
    for (int64_t y = 0; read && y * height < file->picture->height; ++y)
        for (int64_t x = 0; read && x * width < file->picture->width; ++x)
            read = exr_succeeded(exr_read_tile_chunk_info(file->context, 0, (int)x, (int)y, 0, 0, &chunk)) &&
                   read_chunk(file, &chunk, x * width, y * height);
    return read;
}

/* What a 16-bit float (1 + 5 + 10 bits, IEEE 754) may have been rounded from. */
static struct value_range of_half(float value)
{
    const float size = fabsf(value);
    if (!isfinite(value))
        return isnan(value) ? (struct value_range){value, value}
                            : (struct value_range){value < 0 ? value : 65504, value < 0 ? -65504 : value};
    const float half_step = ldexpf(1, (size < 0x1p-14f ? -14 : ilogbf(size)) - 11);
    return (struct value_range){value - half_step, value + half_step};
}

static void find_ranges(const struct exr_input *file)
{
    struct value_range *rgb = file->picture->rgb;
    const bool grey = file->channels[0] == file->channels[2];
    for (size_t i = (size_t)file->picture->width * file->picture->height * 3; i-- > 0;) {
        const float value =
            rgb[grey ? i - i % 3 : i].low; /* grey stands in the first channel, which comes last */
        rgb[i] = file->is_half[i % 3] ? of_half(value) : (struct value_range){value, value};
    }
}

static enum status decode(struct exr_input *file)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = exr_error_keep;
    initializer.user_data = file;
    initializer.read_fn = on_read;
    initializer.size_fn = on_size;
    initializer.max_tile_width = initializer.max_tile_height = LARGEST_TILE;
    bool tiled;
    exr_error_clear();
    if (!exr_succeeded(exr_start_read(&file->context, file->input->path, &initializer)) ||
        !check_windows(file))
        return STATUS_REFUSED;
    const exr_attr_box2i_t window = file->window;
    const enum status status =
        read_image_create(file->input, (unsigned long)((int64_t)window.max.x - window.min.x + 1),
                          (unsigned long)((int64_t)window.max.y - window.min.y + 1), file->picture);
    file->reported = status != STATUS_DONE;
    if (file->reported)
        return status;
    if (!check_storage(file, &tiled) || !choose_channels(file) ||
        !(tiled ? read_tiles : read_scanlines)(file))
        return STATUS_REFUSED;
    find_ranges(file);
    return STATUS_DONE;
}

enum status image_read_exr(const struct read_input *input, struct read_image *picture)
{
    struct exr_input file = {.input = input, .picture = picture};
    const enum status status = decode(&file);
    if (file.pipeline.channels)
        exr_decoding_destroy(file.context, &file.pipeline);
    if (file.context)
        exr_finish(&file.context);
    if (status == STATUS_REFUSED && !file.reported)
        log_error("%s: cannot read EXR: %s", input->path, exr_error());
    return status;
}
