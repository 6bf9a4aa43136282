#include "watch/window.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/heatmap.h"

enum status watch_window_create(struct vulkan_context *context, unsigned width, unsigned height,
                                struct watch_window **pointer)
{
    struct watch_window *window = *pointer = calloc(1, sizeof *window);
    if (!window) {
        log_error("no memory for a window");
        return STATUS_UNABLE;
    }
    srgb_encoder_init(&window->encoder);
    enum status status = display_create(context, width, height, &window->display);
    if (status != STATUS_DONE)
        watch_window_destroy(pointer);
    return status;
}

void watch_window_destroy(struct watch_window **pointer)
{
    struct watch_window *window = *pointer;
    *pointer = NULL;
    if (!window)
        return;
    display_destroy(&window->display);
    free(window);
}

/* RGBA of four bytes a pixel; NULL (reported) without memory. */
static uint8_t *allocate_rgba(const struct image *image)
{
    uint8_t *rgba = malloc((size_t)image->width * image->height * 4);
    if (!rgba)
        log_error("no memory to show %ux%u pixels", image->width, image->height);
    return rgba;
}

static enum status show(struct watch_window *window, const struct image *image, uint8_t *rgba)
{
    enum status status = display_show(window->display, rgba, image->width, image->height);
    free(rgba);
    return status;
}

enum status watch_window_show(struct watch_window *window, const struct image *image, enum transfer transfer)
{
    size_t pixels = (size_t)image->width * image->height;
    uint8_t *rgba = allocate_rgba(image);
    if (!rgba)
        return STATUS_UNABLE;
    for (size_t i = 0; i < pixels; ++i) {
        uint8_t *pixel = rgba + 4 * i;
        if (transfer == TRANSFER_SRGB)
            srgb_encode(&window->encoder, image->rgb + 3 * i, 3, pixel);
        else
            linear_encode(image->rgb + 3 * i, 3, pixel);
        pixel[3] = 255;
    }
    return show(window, image, rgba);
}

enum status watch_window_show_difference(struct watch_window *window, const struct image *image,
                                         const struct image *reference)
{
    size_t pixels = (size_t)image->width * image->height;
    uint8_t *rgba = allocate_rgba(image);
    if (!rgba)
        return STATUS_UNABLE;
    for (size_t i = 0; i < pixels; ++i) {
        heatmap_color(image->rgb + 3 * i, reference->rgb + 3 * i, rgba + 4 * i);
        rgba[4 * i + 3] = 255;
    }
    return show(window, image, rgba);
}

void watch_window_title(struct watch_window *window, const char *format, ...)
{
    char title[sizeof window->title];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(title, sizeof title, format, arguments);
    va_end(arguments);
    if (strcmp(title, window->title) == 0)
        return;
    strcpy(window->title, title);
    display_set_title(window->display, title);
}
