#include <openexr.h>
#include <stdio.h>
#include <string.h>

#include "base/output_file.h"
#include "image/formats.h"

static const char truncation_channel[] = "truncation_bound";

struct exr_output {
    struct output_file file;
    const struct image *image;
    exr_context_t context;
    exr_encode_pipeline_t pipeline;
    bool pipeline_started;
};

/* The first thing the library complained of. Its error callback gets no user data where it has no context
 * yet. */
static _Thread_local char problem[256];

static void on_error(exr_const_context_t context, exr_result_t result, const char *message)
{
    (void)context;
    if (problem[0] == '\0')
        snprintf(problem, sizeof problem, "%s", message ? message : exr_get_default_error_message(result));
}

static int64_t on_write(exr_const_context_t context, void *user_data, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t report_error)
{
    (void)context;
    (void)report_error;
    struct exr_output *output = user_data;
    return output_file_write_at(&output->file, bytes, (size_t)size, offset) ? (int64_t)size : -1;
}

static bool succeeded(exr_result_t result)
{
    if (result != EXR_ERR_SUCCESS)
        on_error(NULL, result, NULL);
    return result == EXR_ERR_SUCCESS;
}

static bool set_text(exr_context_t context, const char *name, const char *text)
{
    return !text || succeeded(exr_attr_set_string(context, 0, name, text));
}

static bool write_header(struct exr_output *output, const struct image_metadata *metadata)
{
    exr_context_t context = output->context;
    int part;
    if (!succeeded(exr_add_part(context, "picture", EXR_STORAGE_SCANLINE, &part)) ||
        !succeeded(exr_initialize_required_attr_simple(context, part, (int32_t)output->image->width,
                                                       (int32_t)output->image->height, EXR_COMPRESSION_ZIP)))
        return false;
    const char *const channels[] = {"B", "G", "R", truncation_channel};
    for (int c = 0; c < (output->image->truncation ? 4 : 3); ++c)
        if (!succeeded(
                exr_add_channel(context, part, channels[c], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1)))
            return false;
    return set_text(context, "scene", metadata->scene) && set_text(context, "device", metadata->device) &&
           set_text(context, "precision", metadata->precision) &&
           succeeded(exr_attr_set_int(context, part, "maxBounces", (int32_t)metadata->max_bounces)) &&
           succeeded(exr_write_header(context));
}

/* Tells where the channel's values lie from row y on. */
static void point_to_channel(const struct image *image, int y, exr_coding_channel_info_t *channel)
{
    const char *name = channel->channel_name;
    bool is_color = strcmp(name, truncation_channel) != 0;
    size_t stride = is_color ? 3 : 1, offset = name[0] == 'G' ? 1 : name[0] == 'B' ? 2 : 0;
    const float *values = is_color ? image->rgb + offset : image->truncation;
    channel->encode_from_ptr = (const uint8_t *)(values + (size_t)y * image->width * stride);
    channel->user_pixel_stride = (int32_t)(stride * sizeof(float));
    channel->user_line_stride = (int32_t)(image->width * stride * sizeof(float));
}

/* Writes the chunk of rows that starts at y. */
static bool write_chunk(struct exr_output *output, int y)
{
    exr_encode_pipeline_t *pipeline = &output->pipeline;
    exr_chunk_info_t chunk;
    if (!succeeded(exr_write_scanline_chunk_info(output->context, 0, y, &chunk)))
        return false;

    bool first = !output->pipeline_started;
    output->pipeline_started = true;
    if (!succeeded(first ? exr_encoding_initialize(output->context, 0, &chunk, pipeline)
                         : exr_encoding_update(output->context, 0, &chunk, pipeline)))
        return false;

    for (int c = 0; c < pipeline->channel_count; c++)
        point_to_channel(output->image, y, &pipeline->channels[c]);
    if (first && !succeeded(exr_encoding_choose_default_routines(output->context, 0, pipeline)))
        return false;
    return succeeded(exr_encoding_run(output->context, 0, pipeline));
}

static bool encode(struct exr_output *output, const struct image_metadata *metadata)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = on_error;
    initializer.user_data = output;
    initializer.write_fn = on_write;
    initializer.zip_level = 1; /* level 6 takes 20 % longer for 1 % of the size: mantissas are noise */
    if (!succeeded(
            exr_start_write(&output->context, output->file.path, EXR_WRITE_FILE_DIRECTLY, &initializer)))
        return false;

    int32_t rows_per_chunk = 0;
    bool written = write_header(output, metadata) &&
                   succeeded(exr_get_scanlines_per_chunk(output->context, 0, &rows_per_chunk));
    for (int64_t y = 0; written && y < output->image->height; y += rows_per_chunk)
        written = write_chunk(output, (int)y);
    if (output->pipeline_started)
        exr_encoding_destroy(output->context, &output->pipeline);
    return succeeded(exr_finish(&output->context)) && written;
}

enum status image_write_exr(const struct image *image, const char *path,
                            const struct image_metadata *metadata)
{
    struct exr_output output = {.image = image};
    enum status status = output_file_open(path, &output.file);
    if (status != STATUS_DONE)
        return status;

    problem[0] = '\0';
    if (encode(&output, metadata) || output.file.error != 0)
        return output_file_commit(&output.file);
    log_error("%s: cannot write EXR: %s", path, problem);
    output_file_abandon(&output.file);
    return STATUS_UNABLE;
}
