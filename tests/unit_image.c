/* Pictures and picture files: what is written reads back. */
#include "cmocka_test.h"

#include <limits.h>
#include <openexr.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/exr_input.h"
#include "image/read.h"
#include "image/tile.h"
#include "image/transfer.h"
#include "test_folder.h"

static const char long_scene[] = "scenes/a folder with a name that goes on/and on/picture.yaml";

static const struct image_metadata metadata = {
    .scene = long_scene, .device = "Ger\xc3\xa4t", .precision = "double", .max_bounces = 7};

/* Mostly radiance in [-0.1, 1.2), and all kinds of floats in between. */
static struct image random_picture(unsigned width, unsigned height)
{
    struct image image;
    assert_int_equal(image_create(width, height, &image), STATUS_DONE);
    uint32_t random = width * 7919 + height;
    for (size_t i = 0; i < (size_t)width * height * 3; i++) {
        random = random * 1664525 + 1013904223;
        if (random >> 28 == 0)
            memcpy(&image.rgb[i], &(uint32_t){random << 4 | random >> 20}, sizeof(float));
        else
            image.rgb[i] = (float)(random >> 8) * 0x1p-24f * 1.3f - 0.1f;
    }
    memcpy(&image.rgb[0], &(uint32_t){0xffc12345}, sizeof(float)); /* a NaN whose bits must survive */
    return image;
}

static void test_create_refuses_what_memory_cannot_hold(void **state)
{
    (void)state;
    const double memory_bytes = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    /* 2^31 * 2^31 * 12 wraps around to 0 in 64 bits; 2^30 squared * 12 stays just below 2^64. */
    const unsigned sizes[][2] = {{UINT_MAX, UINT_MAX},
                                 {1u << 31, 1u << 31},
                                 {1u << 30, 1u << 30},
                                 {65536, (unsigned)(memory_bytes / 12.0 / 65536.0) + 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct image image = {.rgb = (float[]){0}};
        char line[256], bytes[64];
        test_messages_begin();
        enum status status = image_create(sizes[i][0], sizes[i][1], &image);
        int lines = test_messages_end(line);
        assert_int_equal(status, STATUS_UNABLE);
        assert_null(image.rgb);
        assert_int_equal(lines, 1);
        snprintf(bytes, sizeof bytes, "%.0f bytes", (double)sizes[i][0] * (double)sizes[i][1] * 12.0);
        assert_non_null(strstr(line, bytes));
        assert_non_null(strstr(line, "this machine has"));
    }
}

static void test_format_of(void **state)
{
    (void)state;
    assert_int_equal(image_format_of("a.png"), IMAGE_FORMAT_PNG);
    assert_int_equal(image_format_of("a.b/c.pfm.EXR"), IMAGE_FORMAT_EXR);
    assert_int_equal(image_format_of("a.Pfm"), IMAGE_FORMAT_PFM);
    const struct {
        const char *path, *found;
    } unknown[] = {
        {"", "no suffix"},        {"a", "no suffix"},          {"png", "no suffix"},
        {"a.png/b", "no suffix"}, {"a.jpg", "not \".jpg\""},   {"a.pngx", "not \".pngx\""},
        {"a.", "not \".\""},      {"a.png ", "not \".png \""},
    };
    for (size_t i = 0; i < sizeof unknown / sizeof unknown[0]; i++) {
        char line[256];
        test_messages_begin();
        enum image_format format = image_format_of(unknown[i].path);
        int lines = test_messages_end(line);
        assert_int_equal(format, IMAGE_FORMAT_UNKNOWN);
        assert_int_equal(lines, 1);
        assert_non_null(strstr(line, ".png, .exr or .pfm"));
        assert_non_null(strstr(line, unknown[i].found));
    }
}

static void test_check(void **state)
{
    (void)state;
    char line[256];
    assert_int_equal(image_write_check("a.png"), STATUS_DONE);
    test_messages_begin();
    enum status unknown = image_write_check("a.gif");
    enum status missing = image_write_check("missing/a.png");
    struct image image = random_picture(1, 1);
    enum status written = image_write(&image, "a.gif", &metadata);
    assert_int_equal(test_messages_end(line), 3);
    assert_int_equal(unknown, STATUS_REFUSED);
    assert_int_equal(missing, STATUS_UNABLE);
    assert_int_equal(written, STATUS_REFUSED);
    assert_int_equal(test_folder_files(0), 0);
    image_destroy(&image);
}

static void assert_png_text(png_structp png, png_infop info, const char *key, const char *text, int kind)
{
    png_textp texts;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    for (int i = 0; i < count; i++)
        if (strcmp(texts[i].key, key) == 0) {
            assert_string_equal(texts[i].text, text);
            assert_int_equal(texts[i].compression, kind);
            return;
        }
    fail_msg("no text \"%s\"", key);
}

static void check_png(const struct image *image, enum transfer transfer)
{
    FILE *stream = fopen("a.png", "rb");
    assert_non_null(stream);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    assert_int_equal(png_get_image_width(png, info), image->width);
    assert_int_equal(png_get_image_height(png, info), image->height);
    assert_int_equal(png_get_bit_depth(png, info), 8);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    int intent;
    assert_int_equal(png_get_sRGB(png, info, &intent) != 0, transfer == TRANSFER_SRGB);
    png_fixed_point gamma = 0;
    assert_true(png_get_gAMA_fixed(png, info, &gamma));
    assert_int_equal(gamma, transfer == TRANSFER_SRGB ? 45455 : 100000);
    assert_png_text(png, info, "scene", long_scene, PNG_TEXT_COMPRESSION_NONE);
    assert_png_text(png, info, "device", "Ger\xc3\xa4t", PNG_ITXT_COMPRESSION_NONE);
    assert_png_text(png, info, "precision", "double", PNG_TEXT_COMPRESSION_NONE);
    assert_png_text(png, info, "maxBounces", "7", PNG_TEXT_COMPRESSION_NONE);

    struct transfer_encoder encoder;
    transfer_encoder_init(transfer, &encoder);
    size_t channels = (size_t)image->width * 3;
    uint8_t *expected = malloc(channels);
    assert_non_null(expected);
    for (unsigned y = 0; y < image->height; y++) {
        transfer_encode(&encoder, image->rgb + y * channels, channels, expected);
        assert_memory_equal(png_get_rows(png, info)[y], expected, channels);
    }
    free(expected);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(stream);
}

static const unsigned sizes[][2] = {{1, 1}, {1, 16}, {3, 17}, {65, 31}, {300, 200}, {65536, 2}, {1, 70000}};
enum { SIZE_COUNT = sizeof sizes / sizeof sizes[0] };

static void test_png(void **state)
{
    (void)state;
    for (int i = 0; i < SIZE_COUNT; i++)
        for (int transfer = TRANSFER_SRGB; transfer <= TRANSFER_LINEAR; transfer++) {
            struct image image = random_picture(sizes[i][0], sizes[i][1]);
            struct image_metadata with_transfer = metadata;
            with_transfer.transfer = (enum transfer)transfer;
            assert_int_equal(image_write(&image, "a.png", &with_transfer), STATUS_DONE);
            check_png(&image, with_transfer.transfer);
            image_destroy(&image);
        }
}

static void assert_exr_text(exr_context_t file, const char *name, const char *expected)
{
    const char *text = NULL;
    int32_t length = 0;
    assert_int_equal(exr_attr_get_string(file, 0, name, &length, &text), EXR_ERR_SUCCESS);
    assert_int_equal(length, strlen(expected));
    assert_memory_equal(text, expected, strlen(expected));
}

static void test_exr(void **state)
{
    (void)state;
    for (int i = 0; i < SIZE_COUNT; i++) {
        struct image image = random_picture(sizes[i][0], sizes[i][1]);
        assert_int_equal(image_write(&image, "a.exr", &metadata), STATUS_DONE);

        exr_context_t file;
        assert_int_equal(exr_start_read(&file, "a.exr", NULL), EXR_ERR_SUCCESS);
        exr_attr_box2i_t window;
        exr_compression_t compression;
        assert_int_equal(exr_get_data_window(file, 0, &window), EXR_ERR_SUCCESS);
        assert_int_equal(window.min.x, 0);
        assert_int_equal(window.min.y, 0);
        assert_int_equal(window.max.x, image.width - 1);
        assert_int_equal(window.max.y, image.height - 1);
        assert_int_equal(exr_get_compression(file, 0, &compression), EXR_ERR_SUCCESS);
        assert_int_equal(compression, EXR_COMPRESSION_ZIP);
        assert_exr_text(file, "scene", long_scene);
        assert_exr_text(file, "device", "Ger\xc3\xa4t");
        assert_exr_text(file, "precision", "double");
        int32_t max_bounces = 0;
        assert_int_equal(exr_attr_get_int(file, 0, "maxBounces", &max_bounces), EXR_ERR_SUCCESS);
        assert_int_equal(max_bounces, 7);

        const exr_attr_chlist_t *channels;
        assert_int_equal(exr_get_channels(file, 0, &channels), EXR_ERR_SUCCESS);
        assert_int_equal(channels->num_channels, 3);
        for (int c = 0; c < 3; c++) {
            assert_string_equal(channels->entries[c].name.str, ((const char *[]){"B", "G", "R"})[c]);
            assert_int_equal(channels->entries[c].pixel_type, EXR_PIXEL_FLOAT);
        }
        assert_int_equal(exr_finish(&file), EXR_ERR_SUCCESS);

        const struct image_wanted wanted = {{0, 0, image.width, image.height}, TRANSFER_LINEAR};
        struct read_image found;
        assert_int_equal(image_read("a.exr", &wanted, &found), STATUS_DONE);
        for (size_t k = 0; k < (size_t)image.width * image.height * 3; k++)
            if (memcmp(&found.rgb[k].low, &image.rgb[k], sizeof(float)) != 0)
                fail_msg("value %zu has other bits", k);
        read_image_destroy(&found);
        image_destroy(&image);
    }
}

/* Bounds are a part of their own, and there where one is not 0; rows that do not lie together are parts. */
static void test_exr_parts(void **state)
{
    (void)state;
    const struct window window = {3, 20, 5, 7};
    struct image image = random_picture(window.width, window.height);
    struct image_metadata placed = metadata;
    placed.picture_width = 100;
    placed.picture_height = 80;
    placed.window = window;
    placed.strips = (struct strips){3, 9}; /* rows 20 to 22, 32 to 34, 44 */
    image.truncation = calloc((size_t)window.width * window.height, sizeof *image.truncation);
    assert_non_null(image.truncation);
    for (int bounds = 0; bounds < 2; ++bounds) {
        image.truncation[6] = bounds ? 0.25f : 0;
        assert_int_equal(image_write(&image, "a.exr", &placed), STATUS_DONE);
        struct exr_input input;
        int parts;
        assert_int_equal(exr_input_open("a.exr", &input), STATUS_DONE);
        assert_int_equal(exr_get_count(input.context, &parts), EXR_ERR_SUCCESS);
        assert_int_equal(parts, bounds ? 6 : 3);
        for (int part = 0; part < 3 + 3 * bounds; ++part) {
            static const char *const colors[] = {"R", "G", "B"}, *const bound[] = {"truncation_bound"};
            const struct window strip = window_strip(window, placed.strips, (unsigned)(part % 3) * 3);
            struct window data, display;
            assert_true(exr_input_windows(&input, part, &data, &display));
            assert_memory_equal(&data, &strip, sizeof data);
            assert_memory_equal(&display, (&(struct window){0, 0, 100, 80}), sizeof display);
            for (unsigned y = 0; y < strip.height; ++y) {
                const size_t first = ((size_t)(part % 3) * 3 + y) * window.width;
                const float *row;
                assert_int_equal(exr_input_read(&input, part, (int)(strip.y + y), part < 3 ? colors : bound,
                                                part < 3 ? 3 : 1, &row),
                                 STATUS_DONE);
                assert_memory_equal(row, part < 3 ? image.rgb + 3 * first : image.truncation + first,
                                    window.width * (part < 3 ? 3 : 1) * sizeof *row);
            }
        }
        exr_input_close(&input);
    }
    image_destroy(&image);
}

/* Every row of a picture is in one tile, and there in the place that the tile says; the tiles are even. */
static void test_tiles(void **state)
{
    (void)state;
    const struct window whole = {7, 11, 5, 1080};
    for (unsigned count = 1; count <= whole.height; count += count < 70 ? 1 : 101) {
        unsigned rows = 0, least = UINT_MAX, most = 0;
        for (unsigned number = 1; number <= count; ++number) {
            const struct tile tile = {number, count, whole};
            struct window window;
            struct strips strips;
            char text[TILE_TEXT];
            struct tile parsed;
            assert_true(tile_rows(&tile, &window, &strips));
            for (unsigned y = 0, at; y < window.height; ++y) {
                const unsigned picture_row = window_strip(window, strips, y).y;
                assert_int_equal(tile_of_row(&tile, picture_row - whole.y, &at), number);
                assert_int_equal(at, y);
            }
            rows += window.height;
            least = window.height < least ? window.height : least;
            most = window.height > most ? window.height : most;
            tile_print(&tile, text);
            assert_true(tile_parse(text, &parsed));
            assert_memory_equal(&parsed, &tile, sizeof tile);
        }
        assert_int_equal(rows, whole.height);
        if (count <= 67) /* 16 rows each and more */
            assert_true(16 * (most - least) <= most);
    }
    const char *const wrong[] = {"",
                                 "1/2",
                                 "0/2 of 0,0,1,2",
                                 "3/2 of 0,0,1,2",
                                 "1/2 of 0,0,1,2 ",
                                 "1/3 of 0,0,1,2",
                                 "1/2 of 0,0,0,2",
                                 "1/2 of 0,0,1,99999999",
                                 "+1/2 of 0,0,1,2"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i)
        assert_false(tile_parse(wrong[i], &(struct tile){0}));
}

static void test_exr_leaves_out_what_is_unknown(void **state)
{
    (void)state;
    struct image image = random_picture(2, 2);
    assert_int_equal(image_write(&image, "a.exr", &(struct image_metadata){.max_bounces = 0}), STATUS_DONE);
    exr_context_t file;
    assert_int_equal(exr_start_read(&file, "a.exr", NULL), EXR_ERR_SUCCESS);
    const char *const names[] = {"scene", "device", "precision"};
    for (int i = 0; i < 3; i++) {
        const exr_attribute_t *attribute;
        assert_int_equal(exr_get_attribute_by_name(file, 0, names[i], &attribute), EXR_ERR_NO_ATTR_BY_NAME);
    }
    assert_int_equal(exr_finish(&file), EXR_ERR_SUCCESS);
    image_destroy(&image);
}

/* No format but PFM can say that a picture has no pixels: stands for all that a library may refuse. */
static void test_refusal_by_the_library(void **state)
{
    (void)state;
    const char *const names[] = {"a.exr", "a.png"};
    struct image image;
    assert_int_equal(image_create(0, 0, &image), STATUS_DONE);
    for (int i = 0; i < 2; i++) {
        char line[256];
        test_messages_begin();
        log_set_verbosity(-1);
        enum status status = image_write(&image, names[i], &metadata);
        log_set_verbosity(0);
        int lines = test_messages_end(line);
        assert_int_equal(status, STATUS_UNABLE);
        if (lines != 1 || !strstr(line, ": cannot write ") || !strstr(line, names[i]))
            fail_msg("%d lines: %s", lines, line);
        assert_int_equal(test_folder_files(0), 0);
    }
    image_destroy(&image);
}

static void test_pfm(void **state)
{
    (void)state;
    for (int i = 0; i < SIZE_COUNT; i++) {
        struct image image = random_picture(sizes[i][0], sizes[i][1]);
        assert_int_equal(image_write(&image, "a.pfm", &metadata), STATUS_DONE);
        char expected[64], header[64] = "";
        snprintf(expected, sizeof expected, "PF\n%u %u\n-1.0\n", image.width, image.height);
        FILE *stream = fopen("a.pfm", "rb");
        assert_non_null(stream);
        assert_int_equal(fread(header, 1, strlen(expected), stream), strlen(expected));
        assert_string_equal(header, expected);
        size_t row_bytes = (size_t)image.width * 3 * sizeof(float);
        char *row = malloc(row_bytes);
        assert_non_null(row);
        for (unsigned y = image.height; y-- > 0;) {
            assert_int_equal(fread(row, 1, row_bytes, stream), row_bytes);
            assert_memory_equal(row, image.rgb + (size_t)y * image.width * 3, row_bytes);
        }
        assert_int_equal(fgetc(stream), EOF);
        free(row);
        fclose(stream);
        image_destroy(&image);
    }
}

/* Nothing in a file depends on the time or on memory that was not written. */
static void test_same_picture_same_bytes(void **state)
{
    (void)state;
    const char *const names[][2] = {{"a.png", "b.png"}, {"a.exr", "b.exr"}, {"a.pfm", "b.pfm"}};
    const struct image_metadata nothing = {.max_bounces = 5};
    struct image image = random_picture(40, 30);
    for (int i = 0; i < 3; i++) {
        static char bytes[2][65536];
        size_t lengths[2];
        for (int j = 0; j < 2; j++) {
            assert_int_equal(image_write(&image, names[i][j], &nothing), STATUS_DONE);
            FILE *stream = fopen(names[i][j], "rb");
            assert_non_null(stream);
            lengths[j] = fread(bytes[j], 1, sizeof bytes[j], stream);
            fclose(stream);
        }
        assert_int_equal(lengths[0], lengths[1]);
        assert_memory_equal(bytes[0], bytes[1], lengths[0]);
    }
    image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_create_refuses_what_memory_cannot_hold),
        cmocka_unit_test(test_format_of),
        TEST_IN_FOLDER(test_check),
        TEST_IN_FOLDER(test_png),
        TEST_IN_FOLDER(test_exr),
        TEST_IN_FOLDER(test_exr_parts),
        cmocka_unit_test(test_tiles),
        TEST_IN_FOLDER(test_exr_leaves_out_what_is_unknown),
        TEST_IN_FOLDER(test_refusal_by_the_library),
        TEST_IN_FOLDER(test_pfm),
        TEST_IN_FOLDER(test_same_picture_same_bytes),
    };
    return cmocka_run_group_tests_name("image", tests, NULL, NULL);
}
