#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/output_file.h"
#include "image/exr_error.h"
#include "image/formats.h"

struct exr_output {
    struct output_file file;
    const struct image_rows *rows;
    const struct image_metadata *metadata;
    struct window window; /* of the picture, that the rows are */
    struct strips strips;
    exr_context_t context;
    float *values;      /* of a chunk */
    enum status status; /* of the rows */
};

/* Colours and bounds are parts of the file: readers take a channel beside R, G and B for alpha (OpenImageIO).
 * So are rows that do not lie together. */
struct part {
    bool truncation;
    unsigned first;       /* of the rows */
    struct window window; /* where they lie */
};

static int parts_of_a_kind(const struct exr_output *output)
{
    return (int)window_strip_count(output->window, output->strips);
}

static struct part get_part(const struct exr_output *output, int index)
{
    const int of_a_kind = parts_of_a_kind(output);
    const unsigned first = (unsigned)(index % of_a_kind) * output->strips.rows;
    return (struct part){index >= of_a_kind, first, window_strip(output->window, output->strips, first)};
}

static int count_parts(const struct exr_output *output)
{
    return parts_of_a_kind(output) * (output->rows->bounds_truncation ? 2 : 1);
}

static int64_t on_write(exr_const_context_t context, void *user_data, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t report_error)
{
    (void)context;
    (void)report_error;
    struct exr_output *output = user_data;
    return output_file_write_at(&output->file, bytes, (size_t)size, offset) ? (int64_t)size : -1;
}

static bool set_text(exr_context_t context, const char *name, const char *text)
{
    return !text || exr_succeeded(exr_attr_set_string(context, 0, name, text));
}

static exr_attr_box2i_t box_of(const struct window *window)
{
    exr_attr_box2i_t box;
    box.min.x = (int32_t)window->x;
    box.min.y = (int32_t)window->y;
    box.max.x = (int32_t)(window->x + window->width) - 1;
    box.max.y = (int32_t)(window->y + window->height) - 1;
    return box;
}

static bool add_part(const struct exr_output *output, int index)
{
    const struct part part = get_part(output, index);
    const struct image_metadata *metadata = output->metadata;
    const bool whole = metadata->picture_width == 0;
    const exr_attr_box2i_t data = box_of(&part.window);
    const exr_attr_box2i_t display = box_of(
        whole ? &output->window : &(struct window){0, 0, metadata->picture_width, metadata->picture_height});
    const exr_attr_v2f_t center = {.x = 0, .y = 0};
    char name[32];
    int at, number = index % parts_of_a_kind(output);
    snprintf(name, sizeof name, number == 0 ? "%s" : "%s %d", part.truncation ? "truncation" : "picture",
             number + 1);
    if (!exr_succeeded(exr_add_part(output->context, name, EXR_STORAGE_SCANLINE, &at)) ||
        !exr_succeeded(exr_initialize_required_attr(output->context, at, &display, &data, 1, &center, 1,
                                                    EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP)))
        return false;
    static const char *const channels[] = {"truncation_bound", "B", "G", "R"};
    for (int c = part.truncation ? 0 : 1; c < (part.truncation ? 1 : 4); ++c)
        if (!exr_succeeded(exr_add_channel(output->context, at, channels[c], EXR_PIXEL_FLOAT,
                                           EXR_PERCEPTUALLY_LINEAR, 1, 1)))
            return false;
    return true;
}

static bool write_header(const struct exr_output *output)
{
    const struct image_metadata *metadata = output->metadata;
    exr_context_t context = output->context;
    for (int i = 0; i < count_parts(output); ++i)
        if (!add_part(output, i))
            return false;
    return set_text(context, "scene", metadata->scene) && set_text(context, "device", metadata->device) &&
           set_text(context, "precision", metadata->precision) &&
           set_text(context, "settings", metadata->settings) &&
           set_text(context, "digest", metadata->digest) && set_text(context, "tile", metadata->tile) &&
           exr_succeeded(exr_attr_set_int(context, 0, "maxBounces", (int32_t)metadata->max_bounces)) &&
           exr_succeeded(exr_write_header(context));
}

/* Gathers the rows of a chunk. */
static bool read_rows(struct exr_output *output, bool truncation, unsigned first, unsigned count)
{
    const size_t values = (size_t)output->rows->width * (truncation ? 1 : 3);
    for (unsigned i = 0; i < count && output->status == STATUS_DONE; ++i) {
        const float *row;
        output->status = output->rows->read(output->rows->context, first + i, truncation, &row);
        if (output->status == STATUS_DONE)
            memcpy(output->values + i * values, row, values * sizeof *row);
    }
    return output->status == STATUS_DONE;
}

/* Writes the chunk of a part that begins with its row y. */
static bool write_chunk(struct exr_output *output, int index, const struct part *part, unsigned y)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    if (!exr_succeeded(
            exr_write_scanline_chunk_info(output->context, index, (int)(part->window.y + y), &chunk)) ||
        !read_rows(output, part->truncation, part->first + y, (unsigned)chunk.height))
        return false;
    bool written = exr_succeeded(exr_encoding_initialize(output->context, index, &chunk, &pipeline));
    const int32_t count = pipeline.channel_count;
    for (int32_t c = 0; c < count && written; c++) { /* of B, G, R */
        exr_coding_channel_info_t *channel = &pipeline.channels[c];
        channel->encode_from_ptr = (const uint8_t *)(output->values + (count - 1 - c));
        channel->user_pixel_stride = count * (int32_t)sizeof(float);
        channel->user_line_stride = (int32_t)output->rows->width * channel->user_pixel_stride;
    }
    written = written &&
              exr_succeeded(exr_encoding_choose_default_routines(output->context, index, &pipeline)) &&
              exr_succeeded(exr_encoding_run(output->context, index, &pipeline));
    exr_encoding_destroy(output->context, &pipeline);
    return written;
}

static bool write_part(struct exr_output *output, int index)
{
    const struct part part = get_part(output, index);
    int32_t rows_per_chunk = 0;
    bool written = exr_succeeded(exr_get_scanlines_per_chunk(output->context, index, &rows_per_chunk));
    if (!output->values) /* colours come first */
        output->values = malloc((size_t)rows_per_chunk * output->rows->width * 3 * sizeof *output->values);
    written = written && output->values;
    for (unsigned y = 0; written && y < part.window.height; y += (unsigned)rows_per_chunk)
        written = write_chunk(output, index, &part, y);
    return written;
}

static bool encode(struct exr_output *output)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = exr_error_keep;
    initializer.user_data = output;
    initializer.write_fn = on_write;
    initializer.zip_level = 1; /* level 6 takes 20 % longer for 1 % of the size: mantissas are noise */
    if (!exr_succeeded(
            exr_start_write(&output->context, output->file.path, EXR_WRITE_FILE_DIRECTLY, &initializer)))
        return false;
    bool written = write_header(output);
    for (int i = 0; written && i < count_parts(output); ++i)
        written = write_part(output, i);
    free(output->values);
    return exr_succeeded(exr_finish(&output->context)) && written;
}

enum status image_write_exr(const struct image_rows *rows, const char *path,
                            const struct image_metadata *metadata)
{
    struct exr_output output = {
        .rows = rows, .metadata = metadata, .window = metadata->window, .strips = metadata->strips};
    if (output.window.width == 0)
        output.window = (struct window){.width = rows->width, .height = rows->height};
    enum status status = output_file_open(path, &output.file);
    if (status != STATUS_DONE)
        return status;

    exr_error_clear();
    if (encode(&output) || output.file.error != 0)
        return output_file_commit(&output.file);
    if (output.status == STATUS_DONE)
        log_error("%s: cannot write EXR: %s", path, exr_error());
    output_file_abandon(&output.file);
    return output.status == STATUS_DONE ? STATUS_UNABLE : output.status;
}
