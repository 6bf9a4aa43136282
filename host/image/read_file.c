#include "image/read.h"

#include <ctype.h>
#include <endian.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/text_file.h"
#include "image/formats.h"

static const size_t largest_file = (size_t)1 << 32;

enum status read_image_create(const struct read_input *input, unsigned long width, unsigned long height,
                              struct read_image *picture)
{
    const struct image_wanted *wanted = input->wanted;
    if (width != wanted->window.width || height != wanted->window.height) {
        log_error("%s: the picture must have %ux%u pixels, has %lux%lu", input->path, wanted->window.width,
                  wanted->window.height, width, height);
        return STATUS_REFUSED;
    }
    picture->rgb = calloc((size_t)width * height * 3, sizeof *picture->rgb);
    if (!picture->rgb) {
        log_error("%s: no memory for %lux%lu pixels", input->path, width, height);
        return STATUS_UNABLE;
    }
    picture->width = wanted->window.width;
    picture->height = wanted->window.height;
    return STATUS_DONE;
}

void read_image_destroy(struct read_image *picture)
{
    free(picture->rgb);
    *picture = (struct read_image){0};
}

struct pfm_header {
    unsigned long width, height;
    double scale; /* of all values */
    size_t start; /* of the values */
};

static bool read_pfm_header(const struct read_input *input, struct pfm_header *header)
{
    char text[128] = "", width[12], height[12], scale[32];
    int end = 0;
    memcpy(text, input->bytes, input->size < sizeof text ? input->size : sizeof text - 1);
    sscanf(text, " PF%*[ \t\r\n]%11[0-9] %11[0-9] %31[0-9.eE+-]%n", width, height, scale, &end);
    header->start = (size_t)end + 1;
    return end > 0 && isspace((unsigned char)text[end]) &&
           parse_unsigned(width, strlen(width), UINT32_MAX, &header->width) &&
           parse_unsigned(height, strlen(height), UINT32_MAX, &header->height) &&
           parse_double(scale, strlen(scale), &header->scale) && header->scale != 0;
}

static float float_of(const uint8_t *bytes, bool big_endian)
{
    uint32_t bits;
    float value;
    memcpy(&bits, bytes, sizeof bits);
    bits = big_endian ? be32toh(bits) : le32toh(bits);
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Paul Debevec's PFM, as file.c writes it; a scale other than 1 or -1 multiplies the values. */
enum status image_read_pfm(const struct read_input *input, struct read_image *picture)
{
    struct pfm_header header;
    if (!read_pfm_header(input, &header)) {
        log_error("%s: is no PFM: expected \"PF\", width, height and scale in its first lines", input->path);
        return STATUS_REFUSED;
    }
    enum status status = read_image_create(input, header.width, header.height, picture);
    if (status != STATUS_DONE)
        return status;
    const size_t row = header.width * 3, values = row * header.height;
    const size_t found = input->size > header.start ? input->size - header.start : 0;
    if (found != values * sizeof(float)) {
        log_error("%s: expected %zu bytes behind its header, has %zu", input->path, values * sizeof(float),
                  found);
        return STATUS_REFUSED;
    }
    const float factor = (float)fabs(header.scale);
    for (size_t i = 0; i < values; ++i) {
        const size_t place = (header.height - 1 - i / row) * row + i % row; /* from the bottom to the top */
        const float value = factor * float_of(input->bytes + header.start + 4 * place, header.scale > 0);
        picture->rgb[i] = (struct value_range){value, value};
    }
    return STATUS_DONE;
}

enum status image_read(const char *path, const struct image_wanted *wanted, struct read_image *picture)
{
    static enum status (*const readers[])(const struct read_input *input, struct read_image *picture) = {
        [IMAGE_FORMAT_PNG] = image_read_png,
        [IMAGE_FORMAT_EXR] = image_read_exr,
        [IMAGE_FORMAT_PFM] = image_read_pfm,
    };
    struct read_input input = {.path = path, .wanted = wanted};
    char *bytes = NULL;
    *picture = (struct read_image){0};
    const enum image_format format = image_format_of(path);
    if (format == IMAGE_FORMAT_UNKNOWN)
        return STATUS_REFUSED;
    if (format != IMAGE_FORMAT_EXR) {
        bytes = text_file_read(path, false, largest_file, &input.size);
        if (!bytes)
            return input_file_refuse(path);
    }
    input.bytes = (const uint8_t *)bytes;
    const enum status status = readers[format](&input, picture);
    if (status != STATUS_DONE)
        read_image_destroy(picture);
    free(bytes);
    return status;
}
