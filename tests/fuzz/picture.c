#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include "fuzz.h"
#include "image/formats.h"

/* Makes the check sums of a PNG's chunks right, so that its contents are looked at. */
static void repair_png(uint8_t *bytes, size_t size)
{
    for (size_t at = 8; size >= 12 && at <= size - 12;) {
        const size_t length = (size_t)bytes[at] << 24 | (size_t)bytes[at + 1] << 16 |
                              (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        if (length > size - 12 - at)
            return;
        const uLong sum = crc32(0, bytes + at + 4, (uInt)length + 4);
        for (size_t i = 0; i < 4; ++i)
            bytes[at + 8 + length + i] = (uint8_t)(sum >> (24 - 8 * i));
        at += 12 + length;
    }
}

static enum status read_exr(const uint8_t *bytes, size_t size, const struct image_wanted *wanted,
                            struct read_image *image)
{
    char path[64];
    const int file = memfd_create("fuzz.exr", 0);
    if (file < 0 || write(file, bytes, size) != (ssize_t)size)
        abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    const enum status status = image_read_exr(&(struct read_input){.path = path, .wanted = wanted}, image);
    close(file);
    return status;
}

/* A picture file of 5x3 pixels, PNG, EXR or PFM by its first byte. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct image_wanted wanted = {{0, 0, 5, 3}, TRANSFER_SRGB};
    const bool png = size > 0 && data[0] == 0x89, exr = size > 0 && data[0] == 0x76;
    struct read_image image = {0};
    uint8_t *bytes = malloc(size + (size == 0));
    if (!bytes)
        abort();
    if (size > 0)
        memcpy(bytes, data, size);
    if (png)
        repair_png(bytes, size);
    const struct read_input input = {"fuzz", bytes, size, &wanted};
    const enum status status = png   ? image_read_png(&input, &image)
                               : exr ? read_exr(bytes, size, &wanted, &image)
                                     : image_read_pfm(&input, &image);
    if (status != STATUS_DONE)
        read_image_destroy(&image);
    free(bytes);
    if (status == STATUS_DONE ? image.width != 5 || image.height != 3 : status != STATUS_REFUSED || image.rgb)
        abort();
    for (size_t i = 0; status == STATUS_DONE && i < 5 * 3 * 3; ++i)
        if (image.rgb[i].low > image.rgb[i].high || isnan(image.rgb[i].low) != isnan(image.rgb[i].high))
            abort();
    read_image_destroy(&image);
    return 0;
}
