/* Pictures of other programs: what each format's values stand for, and what is refused. */
#include "cmocka_test.h"

#include <math.h>
#include <openexr.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "image/exr_input.h"
#include "image/read.h"
#include "test_folder.h"

enum { WIDTH = 37, HEIGHT = 21, VALUES = WIDTH * HEIGHT * 3 };
static const struct image_wanted wanted = {{0, 0, WIDTH, HEIGHT}, TRANSFER_SRGB};

/* Radiance from 2^-20 to 2^5, some values negative. */
static void fill(float *rgb)
{
    uint32_t random = 1;
    for (int i = 0; i < VALUES; ++i) {
        random = random * 1664525 + 1013904223;
        rgb[i] =
            ldexpf((float)(random >> 8) * 0x1p-24f + 1, (int)(random % 25) - 20) * (i % 17 == 0 ? -1 : 1);
    }
}

static struct read_image read_or_fail(const char *path, const struct image_wanted *as)
{
    struct read_image image;
    assert_int_equal(image_read(path, as, &image), STATUS_DONE);
    assert_int_equal(image.width, as->window.width);
    assert_int_equal(image.height, as->window.height);
    return image;
}

/* The file is refused with one message, which names it and has the pattern in it. */
static void assert_refused(const char *path, const struct image_wanted *as, const char *pattern)
{
    char line[256];
    struct read_image image;
    test_messages_begin();
    const enum status status = image_read(path, as, &image);
    const int lines = test_messages_end(line);
    if (status != STATUS_REFUSED || lines != 1 || !strstr(line, path) || !strstr(line, pattern) || image.rgb)
        fail_msg("status %d, %d lines, expected '%s': %s", status, lines, pattern, line);
}

static void own_files_read_back(void **state)
{
    (void)state;
    static float rgb[VALUES];
    fill(rgb);
    const struct image image = {.width = WIDTH, .height = HEIGHT, .rgb = rgb};
    const char *const names[] = {"a.exr", "a.pfm"};
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(image_write(&image, names[i], &(struct image_metadata){0}), STATUS_DONE);
        struct read_image read = read_or_fail(names[i], &wanted);
        for (int k = 0; k < VALUES; ++k)
            assert_true(read.rgb[k].low == rgb[k] && read.rgb[k].high == rgb[k]);
        read_image_destroy(&read);
    }
    for (int transfer = TRANSFER_SRGB; transfer <= TRANSFER_LINEAR; ++transfer) {
        struct image_wanted as = wanted;
        as.transfer = (enum transfer)transfer;
        assert_int_equal(image_write(&image, "a.png", &(struct image_metadata){.transfer = as.transfer}),
                         STATUS_DONE);
        struct read_image read = read_or_fail("a.png", &as);
        for (int k = 0; k < VALUES; ++k) {
            assert_true(read.rgb[k].low <= rgb[k] && rgb[k] <= read.rgb[k].high);
            if (rgb[k] > 0.01f && rgb[k] < 0.99f) /* two steps of code values; sRGB's steepest is 2.28 */
                assert_true(read.rgb[k].high - read.rgb[k].low < 2.3f * 2 / 255);
        }
        read_image_destroy(&read);
    }
}

struct exr_kind {
    exr_pixel_type_t type;
    exr_compression_t compression;
    uint32_t tile;           /* pixels a side; 0: scanlines */
    const char *channels[5]; /* sorted by name, as the format wants them */
    int32_t left;            /* of the data window in a display window that is so much wider */
};

static void write_chunk(exr_context_t file, const exr_chunk_info_t *chunk, exr_encode_pipeline_t *pipeline,
                        int x, int y, const float *rgb)
{
    const bool first = !pipeline->channels;
    assert_int_equal(first ? exr_encoding_initialize(file, 0, chunk, pipeline)
                           : exr_encoding_update(file, 0, chunk, pipeline),
                     EXR_ERR_SUCCESS);
    for (int i = 0; i < pipeline->channel_count; ++i) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        const char *color = strchr("RGB", channel->channel_name[0]);
        channel->encode_from_ptr = (const uint8_t *)(rgb + 3 * (y * WIDTH + x) + (color ? color - "RGB" : 0));
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = 3 * sizeof(float);
        channel->user_line_stride = WIDTH * 3 * sizeof(float);
    }
    if (first)
        assert_int_equal(exr_encoding_choose_default_routines(file, 0, pipeline), EXR_ERR_SUCCESS);
    assert_int_equal(exr_encoding_run(file, 0, pipeline), EXR_ERR_SUCCESS);
}

static void write_exr(const struct exr_kind *kind, const float *rgb)
{
    exr_context_t file;
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_attr_box2i_t display = {0}, data = {0};
    data.min.x = kind->left;
    data.max.x = kind->left + WIDTH - 1;
    display.max.x = data.max.x;
    data.max.y = display.max.y = HEIGHT - 1;
    int part;
    int32_t rows = HEIGHT;
    assert_int_equal(exr_start_write(&file, "a.exr", EXR_WRITE_FILE_DIRECTLY, NULL), EXR_ERR_SUCCESS);
    exr_add_part(file, "picture", kind->tile ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part);
    exr_initialize_required_attr(file, 0, &display, &data, 1, &(exr_attr_v2f_t){0}, 1,
                                 EXR_LINEORDER_INCREASING_Y, kind->compression);
    for (int i = 0; i < 5 && kind->channels[i]; ++i)
        exr_add_channel(file, 0, kind->channels[i], kind->type, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    if (kind->tile)
        exr_set_tile_descriptor(file, 0, kind->tile, kind->tile, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN);
    assert_int_equal(exr_write_header(file), EXR_ERR_SUCCESS);
    const int step = kind->tile ? (int)kind->tile : 0;
    if (!step)
        exr_get_scanlines_per_chunk(file, 0, &rows);
    for (int y = 0; y < HEIGHT; y += step ? step : rows)
        for (int x = 0; x < WIDTH; x += step ? step : WIDTH) {
            assert_int_equal(step ? exr_write_tile_chunk_info(file, 0, x / step, y / step, 0, 0, &chunk)
                                  : exr_write_scanline_chunk_info(file, 0, y, &chunk),
                             EXR_ERR_SUCCESS);
            write_chunk(file, &chunk, &pipeline, x, y, rgb);
        }
    exr_encoding_destroy(file, &pipeline);
    assert_int_equal(exr_finish(&file), EXR_ERR_SUCCESS);
}

/* Half floats, in scanlines and tiles, packed in all ways without loss, with one or two other channels beside
 * them. */
static void half_exr(void **state)
{
    (void)state;
    static float rgb[VALUES];
    fill(rgb);
    for (exr_compression_t compression = EXR_COMPRESSION_NONE; compression <= EXR_COMPRESSION_PIZ;
         ++compression)
        for (uint32_t tile = 0; tile <= 16; tile += 16)
            for (int type = EXR_PIXEL_HALF; type <= EXR_PIXEL_FLOAT; ++type) {
                write_exr(
                    &(struct exr_kind){
                        (exr_pixel_type_t)type, compression, tile, {"A", "B", "G", "R", "Z"}, 0},
                    rgb);
                struct read_image read = read_or_fail("a.exr", &wanted);
                for (int k = 0; k < VALUES; ++k) {
                    const float width = read.rgb[k].high - read.rgb[k].low, size = fabsf(rgb[k]);
                    assert_true(read.rgb[k].low <= rgb[k] && rgb[k] <= read.rgb[k].high);
                    assert_true(type == EXR_PIXEL_FLOAT ? width == 0
                                                        : width <= fmaxf(size * 0x1.002p-10f, 0x1p-24f));
                }
                read_image_destroy(&read);
            }
}

/* Of four channels of halves one: OpenEXRCore's fast path for these writes all of them. */
static void one_channel_of_four(void **state)
{
    (void)state;
    static float rgb[VALUES];
    static const char *const green[] = {"G"};
    struct exr_input input;
    const float *row;
    fill(rgb);
    write_exr(&(struct exr_kind){EXR_PIXEL_HALF, EXR_COMPRESSION_NONE, 0, {"A", "B", "G", "R"}, 0}, rgb);
    assert_int_equal(exr_input_open("a.exr", &input), STATUS_DONE);
    assert_int_equal(exr_input_read(&input, 0, 5, green, 1, &row), STATUS_DONE);
    for (int x = 0; x < WIDTH; ++x) {
        const float expected = rgb[3 * (5 * WIDTH + x) + 1];
        assert_true(fabsf(row[x] - expected) <= fmaxf(fabsf(expected) * 0x1p-11f, 0x1p-25f));
    }
    exr_input_close(&input);
}

/* A data window that is a part of the display window is that part of the picture, and nothing else. */
static void windows_of_exr(void **state)
{
    (void)state;
    static float rgb[VALUES];
    fill(rgb);
    const struct exr_kind kind = {EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIP, 0, {"B", "G", "R"}, 7};
    write_exr(&kind, rgb);
    struct image_wanted part = wanted;
    assert_refused("a.exr", &part, "data window");
    part.window.x = 7;
    struct read_image read = read_or_fail("a.exr", &part);
    assert_true(read.rgb[VALUES - 1].low == rgb[VALUES - 1]);
    read_image_destroy(&read);
    part.window.width -= 1;
    assert_refused("a.exr", &part, "must have 36x21 pixels, has 37x21");
}

static void refused_exr(void **state)
{
    (void)state;
    static float rgb[VALUES];
    fill(rgb);
    const struct {
        struct exr_kind kind;
        const char *message;
    } cases[] = {
        {{EXR_PIXEL_FLOAT, EXR_COMPRESSION_PXR24, 0, {"B", "G", "R"}, 0}, "compressed with loss"},
        {{EXR_PIXEL_FLOAT, EXR_COMPRESSION_NONE, 0, {"B", "G"}, 0}, "has no R"},
        {{EXR_PIXEL_FLOAT, EXR_COMPRESSION_NONE, 0, {"B", "R"}, 0}, "has no G"},
        {{EXR_PIXEL_UINT, EXR_COMPRESSION_NONE, 0, {"B", "G", "R"}, 0}, "expected half or float"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        write_exr(&cases[i].kind, rgb);
        assert_refused("a.exr", &wanted, cases[i].message);
    }
}

static void write_png(int color_type, int depth, int interlace, size_t row_bytes, const uint8_t *rows)
{
    FILE *stream = fopen("a.png", "wb");
    assert_non_null(stream);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, WIDTH, HEIGHT, depth, color_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (color_type == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, (png_color[2]){{1, 2, 3}, {4, 5, 6}}, 2);
    png_write_info(png, info);
    for (int pass = png_set_interlace_handling(png); pass > 0; --pass)
        for (int y = 0; y < HEIGHT; ++y)
            png_write_row(png, rows + (size_t)y * row_bytes);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    assert_int_equal(fclose(stream), 0);
}

/* A code value c of n bits stands for what lies between c - 1 and c + 1; the ends are clipped values, too. */
static void kinds_of_png(void **state)
{
    (void)state;
    static uint8_t rows[WIDTH * HEIGHT * 8];
    const struct image_wanted linear = {{0, 0, WIDTH, HEIGHT}, TRANSFER_LINEAR};
    for (size_t i = 0; i < sizeof rows; ++i)
        rows[i] = (uint8_t)(i * 167 % 256);
    const struct {
        int color_type, channels;
    } kinds[] = {{PNG_COLOR_TYPE_GRAY, 1},
                 {PNG_COLOR_TYPE_GRAY_ALPHA, 2},
                 {PNG_COLOR_TYPE_RGB, 3},
                 {PNG_COLOR_TYPE_RGB_ALPHA, 4}};
    for (size_t i = 0; i < 4; ++i)
        for (int depth = 8; depth <= 16; depth += 8)
            for (int interlace = PNG_INTERLACE_NONE; interlace <= PNG_INTERLACE_ADAM7; ++interlace) {
                const int channels = kinds[i].channels, bytes = depth / 8, highest = (1 << depth) - 1;
                write_png(kinds[i].color_type, depth, interlace, (size_t)(WIDTH * channels * bytes), rows);
                char line[256];
                test_messages_begin();
                struct read_image read = read_or_fail("a.png", &linear);
                assert_int_equal(test_messages_end(line), channels % 2 == 0); /* alpha is said */
                for (int k = 0; k < VALUES; ++k) {
                    const uint8_t *code = rows + (k / 3 * channels + (channels > 2 ? k % 3 : 0)) * bytes;
                    const int c = bytes == 1 ? code[0] : code[0] << 8 | code[1];
                    assert_true(read.rgb[k].low == (c == 0 ? -INFINITY : (float)((c - 1.0) / highest)));
                    assert_true(read.rgb[k].high == (c == highest ? INFINITY : (float)((c + 1.0) / highest)));
                }
                read_image_destroy(&read);
            }
    write_png(PNG_COLOR_TYPE_PALETTE, 1, PNG_INTERLACE_NONE, (WIDTH + 7) / 8, rows);
    assert_refused("a.png", &wanted, "palette");
    write_png(PNG_COLOR_TYPE_GRAY, 4, PNG_INTERLACE_NONE, (WIDTH + 1) / 2, rows);
    assert_refused("a.png", &wanted, "8 or 16 bits a channel, has 4");
}

static void kinds_of_pfm(void **state)
{
    (void)state;
    static const uint8_t little[] =
        "PF\n1 2\n-1.0\n\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f\0\0\0\x40\0\0\0\x40\0\0\0\x40",
                         big[] =
                             "PF 1 2 2 \x3f\x80\0\0\x3f\x80\0\0\x3f\x80\0\0\x40\0\0\0\x40\0\0\0\x40\0\0\0";
    const struct image_wanted two = {{0, 0, 1, 2}, TRANSFER_SRGB};
    const struct {
        const uint8_t *bytes;
        size_t size;
        float scale;
    } files[] = {{little, sizeof little - 1, 1}, {big, sizeof big - 1, 2}};
    for (int i = 0; i < 2; ++i) {
        struct read_image read;
        test_write_file("a.pfm", files[i].bytes, files[i].size);
        assert_int_equal(image_read("a.pfm", &two, &read), STATUS_DONE);
        for (int k = 0; k < 6; ++k) /* from the bottom to the top */
            assert_true(read.rgb[k].low == (k < 3 ? 2 : 1) * files[i].scale);
        read_image_destroy(&read);
    }
    const struct {
        const char *text, *message;
    } bad[] = {
        {"", "is no PFM"},
        {"Pf\n1 2\n-1\n", "is no PFM"},
        {"P6\n1 2\n255\n", "is no PFM"},
        {"PF\n1 2\n0\n", "is no PFM"},
        {"PF\n1 -2\n-1\n", "is no PFM"},
        {"PF\n1 2\nnan\n", "is no PFM"},
        {"PF\n1 2", "is no PFM"},
        {"PF\n4294967295 4294967295\n-1\n", "must have 1x2 pixels, has 4294967295x4294967295"},
        {"PF\n1 2\n-1\nabcd", "expected 24 bytes behind its header, has 4"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        test_write_file("a.pfm", bad[i].text, strlen(bad[i].text));
        assert_refused("a.pfm", &two, bad[i].message);
    }
    assert_refused("b.pfm", &two, "No such file");
    assert_refused("a.jpg", &two, ".png, .exr or .pfm");
}

/* At every length a file's beginning is refused, in one message. */
static void truncated_files(void **state)
{
    (void)state;
    static float rgb[VALUES];
    fill(rgb);
    const struct image image = {.width = WIDTH, .height = HEIGHT, .rgb = rgb};
    const char *const names[] = {"a.exr", "a.png", "a.pfm"};
    for (int i = 0; i < 3; ++i) {
        size_t size;
        assert_int_equal(image_write(&image, names[i], &(struct image_metadata){0}), STATUS_DONE);
        char *bytes = text_file_read(names[i], true, 1 << 20, &size);
        assert_non_null(bytes);
        for (size_t length = 0; length < size; length += length < 400 ? 1 : 61) {
            test_write_file(names[i], bytes, length);
            assert_refused(names[i], &wanted, "");
        }
        free(bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(own_files_read_back), TEST_IN_FOLDER(half_exr),
        TEST_IN_FOLDER(one_channel_of_four), TEST_IN_FOLDER(windows_of_exr),
        TEST_IN_FOLDER(refused_exr),         TEST_IN_FOLDER(kinds_of_png),
        TEST_IN_FOLDER(kinds_of_pfm),        TEST_IN_FOLDER(truncated_files),
    };
    return cmocka_run_group_tests_name("read_image", tests, NULL, NULL);
}
