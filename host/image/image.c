#include "image/image.h"

#include <stdlib.h>
#include <unistd.h>

struct window window_strip(struct window window, struct strips strips, unsigned y)
{
    const unsigned left = window.height - y;
    const unsigned of_strip = strips.rows > 0 ? strips.rows - y % strips.rows : left;
    window.y += y + (strips.rows > 0 ? y / strips.rows * strips.skip : 0);
    window.height = of_strip < left ? of_strip : left;
    return window;
}

unsigned window_strip_count(struct window window, struct strips strips)
{
    return strips.rows > 0 ? (window.height + strips.rows - 1) / strips.rows : 1;
}

enum status image_create(unsigned width, unsigned height, struct image *image)
{
    *image = (struct image){0};
    const double wanted_bytes = (double)width * (double)height * 3.0 * (double)sizeof(float);
    const double memory_bytes = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (wanted_bytes > memory_bytes) {
        log_error(
            "a picture of %ux%u pixels takes %.0f bytes (%.1f GiB) of memory, this machine has %.1f GiB",
            width, height, wanted_bytes, wanted_bytes * 0x1p-30, memory_bytes * 0x1p-30);
        return STATUS_UNABLE;
    }
    /* calloc, so that pages nobody draws on are never touched. */
    float *rgb = calloc((size_t)width * height * 3 + 1, sizeof *rgb);
    if (!rgb) {
        log_error("no memory for a picture of %ux%u pixels: %.0f bytes wanted", width, height, wanted_bytes);
        return STATUS_UNABLE;
    }
    *image = (struct image){.width = width, .height = height, .rgb = rgb};
    return STATUS_DONE;
}

enum status image_widen(struct image *image)
{
    image->rgb64 = calloc((size_t)image->width * image->height * 3 + 1, sizeof *image->rgb64);
    if (image->rgb64)
        return STATUS_DONE;
    log_error("no memory for a picture of %ux%u pixels in double precision", image->width, image->height);
    return STATUS_UNABLE;
}

void image_destroy(struct image *image)
{
    free(image->rgb);
    free(image->rgb64);
    free(image->truncation);
    *image = (struct image){0};
}
