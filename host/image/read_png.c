#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "image/formats.h"

enum { LARGEST_CHUNK = 8 << 20 }; /* bytes of a text or profile */

struct png_input {
    const struct read_input *input;
    size_t place; /* of the next byte */
    png_structp png;
    png_infop info;
    uint8_t *codes;              /* all rows; of 16 bits, the upper byte first */
    struct value_range *of_code; /* what a code value stands for */
    enum status status;
};

static void on_error(png_structp png, png_const_charp message)
{
    struct png_input *file = png_get_error_ptr(png);
    if (file->status == STATUS_DONE)
        log_error("%s: cannot read PNG: %s", file->input->path, message);
    file->status = STATUS_REFUSED;
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    const struct png_input *file = png_get_error_ptr(png);
    log_info("%s: PNG: %s", file->input->path, message);
}

/* libpng makes room for a chunk before it reads it: whether none says that it is longer than the file. */
static bool chunks_fit(const struct read_input *input)
{
    enum { SIGNATURE = 8, AROUND_DATA = 12 }; /* bytes: length, type and check sum */
    size_t left =
        input->size > SIGNATURE && png_sig_cmp(input->bytes, 0, SIGNATURE) == 0 ? input->size - SIGNATURE : 0;
    while (left >= AROUND_DATA) {
        const uint8_t *at = input->bytes + input->size - left;
        const size_t length = png_get_uint_32(at);
        left -= AROUND_DATA;
        if (length > left)
            return false;
        left = memcmp(at + 4, "IEND", 4) == 0 ? 0 : left - length;
    }
    return true;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size)
{
    struct png_input *file = png_get_io_ptr(png);
    if (size > file->input->size - file->place)
        png_error(png, "the file ends too early");
    memcpy(bytes, file->input->bytes + file->place, size);
    file->place += size;
}

/* By the transfer function of IEC 61966-2-1:1999, section 5.2. */
static float to_linear(double encoded, enum transfer transfer)
{
    if (transfer == TRANSFER_LINEAR)
        return (float)encoded;
    return (float)(encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4));
}

static bool tabulate_codes(struct png_input *file, unsigned highest)
{
    const enum transfer transfer = file->input->wanted->transfer;
    file->of_code = malloc((highest + 1) * sizeof *file->of_code);
    for (unsigned code = 0; file->of_code && code <= highest; ++code)
        file->of_code[code] = (struct value_range){
            code == 0 ? -INFINITY : to_linear((double)(code - 1) / highest, transfer),
            code == highest ? INFINITY : to_linear((double)(code + 1) / highest, transfer),
        };
    return file->of_code;
}

/* Whether the picture is one whose values are known. */
static bool is_judgeable(const struct png_input *file)
{
    const char *path = file->input->path;
    const unsigned depth = png_get_bit_depth(file->png, file->info);
    png_fixed_point gamma;
    if (png_get_color_type(file->png, file->info) & PNG_COLOR_MASK_PALETTE) {
        log_error("%s: expected a PNG with colours of its own, has a palette", path);
        return false;
    }
    if (depth < 8) {
        log_error("%s: expected a PNG of 8 or 16 bits a channel, has %u", path, depth);
        return false;
    }
    if (png_get_color_type(file->png, file->info) & PNG_COLOR_MASK_ALPHA)
        log_notice("%s: has an alpha channel, which is left out", path);
    if (file->input->wanted->transfer == TRANSFER_SRGB && png_get_gAMA_fixed(file->png, file->info, &gamma) &&
        gamma == PNG_GAMMA_LINEAR)
        log_warning("%s: says that its values are linear, and is taken for sRGB; see --transfer", path);
    return true;
}

static void read_codes(struct png_input *file, size_t row_bytes)
{
    const int passes = png_set_interlace_handling(file->png);
    for (int pass = 0; pass < passes; ++pass)
        for (unsigned y = 0; y < file->input->wanted->window.height; ++y)
            png_read_row(file->png, file->codes + y * row_bytes, NULL);
    png_read_end(file->png, NULL);
}

static void decode(struct png_input *file, struct read_image *picture)
{
    if (setjmp(png_jmpbuf(file->png)))
        return;
    png_set_read_fn(file->png, file, read_bytes);
    png_set_user_limits(file->png, PNG_UINT_31_MAX,
                        PNG_UINT_31_MAX); /* read_image_create() knows what is wanted */
    png_set_chunk_malloc_max(file->png, LARGEST_CHUNK);
    if (!chunks_fit(file->input))
        png_error(file->png, "the file ends too early");
    png_read_info(file->png, file->info);
    file->status = read_image_create(file->input, png_get_image_width(file->png, file->info),
                                     png_get_image_height(file->png, file->info), picture);
    if (file->status == STATUS_DONE && !is_judgeable(file))
        file->status = STATUS_REFUSED;
    if (file->status != STATUS_DONE)
        return;
    const size_t code_bytes = png_get_bit_depth(file->png, file->info) / 8,
                 values = 3 * (size_t)picture->width;
    png_set_gray_to_rgb(file->png);
    png_set_strip_alpha(file->png);
    file->codes = malloc(values * code_bytes * picture->height);
    if (!file->codes || !tabulate_codes(file, code_bytes == 1 ? UINT8_MAX : UINT16_MAX)) {
        log_error("%s: no memory for %ux%u pixels", file->input->path, picture->width, picture->height);
        file->status = STATUS_UNABLE;
        return;
    }
    read_codes(file, values * code_bytes);
    for (size_t i = 0; i < values * picture->height; ++i) {
        const uint8_t *code = file->codes + code_bytes * i;
        picture->rgb[i] = file->of_code[code_bytes == 1 ? code[0] : code[0] << 8 | code[1]];
    }
}

enum status image_read_png(const struct read_input *input, struct read_image *picture)
{
    struct png_input file = {.input = input};
    file.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &file, on_error, on_warning);
    file.info = file.png ? png_create_info_struct(file.png) : NULL;
    if (file.info) {
        decode(&file, picture);
    } else {
        log_error("%s: no memory to read PNG", input->path);
        file.status = STATUS_UNABLE;
    }
    png_destroy_read_struct(&file.png, &file.info, NULL);
    free(file.codes);
    free(file.of_code);
    return file.status;
}
