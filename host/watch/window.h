#ifndef VKWHITTED_WATCH_WINDOW_H
#define VKWHITTED_WATCH_WINDOW_H

#include "image/srgb.h"
#include "watch/display.h"
#include "watch/picture.h"

/* The window of `watch`: pictures and a title. */
struct watch_window {
    struct display *display;
    struct srgb_encoder encoder;
    char title[512];
};

/* Opens a window of this size. On failure (reported) *window is NULL. */
enum status watch_window_create(struct vulkan_context *context, unsigned width, unsigned height,
                                struct watch_window **window);
void watch_window_destroy(struct watch_window **window);

enum status watch_window_show(struct watch_window *window, const struct image *image, enum transfer transfer);

/* Shows where the picture and the reference differ, in the colours of heatmap_write(). */
enum status watch_window_show_difference(struct watch_window *window, const struct image *image,
                                         const struct image *reference);

/* Does nothing where that is the title already. */
__attribute__((format(printf, 2, 3))) void watch_window_title(struct watch_window *window, const char *format,
                                                              ...);

#endif
