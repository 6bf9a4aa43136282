#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/output_file.h"
#include "image/formats.h"
#include "image/transfer.h"

struct png_output {
    struct output_file file;
    const struct png_source *source;
    png_structp png;
    png_infop info;
    uint8_t *row;
};

static void on_error(png_structp png, png_const_charp message)
{
    const struct png_output *output = png_get_error_ptr(png);
    if (output->file.error == 0) /* which is reported when the file is closed */
        log_error("%s: cannot write PNG: %s", output->file.path, message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    const struct png_output *output = png_get_error_ptr(png);
    log_warning("%s: PNG: %s", output->file.path, message);
}

static bool is_ascii(const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text >= 0x80)
            return false;
    return true;
}

/* tEXt is Latin-1: what is not ASCII goes into iTXt, which is UTF-8. */
static void put_text(struct png_output *output, const char *key, const char *value)
{
    const png_text text = {
        .compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
        .key = (char *)(uintptr_t)key,
        .text = (char *)(uintptr_t)value,
    };
    png_set_text(output->png, output->info, &text, 1);
}

/* Z_RLE looks for runs only and leaves the rest to Huffman coding; after the Paeth filter that is as small as
 * zlib's level 3 on smooth pictures, smaller than level 6 on noisy ones, and several times faster. */
static void put_header(struct png_output *output)
{
    const struct png_source *source = output->source;
    png_structp png = output->png;
    png_set_IHDR(png, output->info, source->width, source->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (source->transfer == TRANSFER_SRGB)
        png_set_sRGB_gAMA_and_cHRM(png, output->info, PNG_sRGB_INTENT_PERCEPTUAL);
    else
        png_set_gAMA_fixed(png, output->info, PNG_GAMMA_LINEAR);
    put_text(output, "Software", "vkwhitted");
    for (int i = 0; i < source->text_count; ++i)
        if (source->texts[i].text)
            put_text(output, source->texts[i].key, source->texts[i].text);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    png_set_compression_strategy(png, Z_RLE);
    png_set_compression_level(png, 1);
    png_set_compression_buffer_size(png, 65536);
    png_write_info(png, output->info);
}

static enum status encode(struct png_output *output)
{
    if (setjmp(png_jmpbuf(output->png)))
        return STATUS_UNABLE;
    png_init_io(output->png, output->file.stream);
    put_header(output);
    for (unsigned y = 0; y < output->source->height; y++) {
        const enum status status = output->source->encode_row(output->source->context, y, output->row);
        if (status != STATUS_DONE)
            return status;
        png_write_row(output->png, output->row);
    }
    png_write_end(output->png, NULL);
    return STATUS_DONE;
}

enum status png_write(const struct png_source *source, const char *path)
{
    struct png_output output = {.source = source};
    enum status status = output_file_open(path, &output.file);
    if (status != STATUS_DONE)
        return status;
    output.row = malloc((size_t)source->width * 3);
    output.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, on_error, on_warning);
    output.info = output.png ? png_create_info_struct(output.png) : NULL;
    if (output.row && output.info) {
        status = encode(&output);
    } else {
        log_error("%s: no memory to write PNG", path);
        status = STATUS_UNABLE;
    }
    png_destroy_write_struct(&output.png, &output.info);
    free(output.row);
    if (status == STATUS_DONE || output.file.error != 0)
        return output_file_commit(&output.file);
    output_file_abandon(&output.file);
    return status;
}

struct picture {
    const struct image_rows *rows;
    struct transfer_encoder encoder;
};

static enum status encode_picture_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct picture *picture = context;
    const float *row;
    enum status status = picture->rows->read(picture->rows->context, y, false, &row);
    if (status != STATUS_DONE)
        return status;
    transfer_encode(&picture->encoder, row, (size_t)picture->rows->width * 3, rgb);
    return STATUS_DONE;
}

enum status image_write_png(const struct image_rows *rows, const char *path,
                            const struct image_metadata *metadata)
{
    struct picture picture = {.rows = rows};
    transfer_encoder_init(metadata->transfer, &picture.encoder);
    char max_bounces[16];
    snprintf(max_bounces, sizeof max_bounces, "%u", metadata->max_bounces);
    const struct png_text texts[] = {
        {"scene", metadata->scene},
        {"device", metadata->device},
        {"precision", metadata->precision},
        {"maxBounces", max_bounces},
    };
    const struct png_source source = {
        .width = rows->width,
        .height = rows->height,
        .transfer = metadata->transfer,
        .texts = texts,
        .text_count = (int)(sizeof texts / sizeof texts[0]),
        .encode_row = encode_picture_row,
        .context = &picture,
    };
    return png_write(&source, path);
}
