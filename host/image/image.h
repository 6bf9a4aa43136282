#ifndef VKWHITTED_IMAGE_IMAGE_H
#define VKWHITTED_IMAGE_IMAGE_H

#include <stddef.h>

#include "base/status.h"

/* Part of a picture, in pixels from the top left. */
struct window {
    unsigned x, y, width, height;
};

/* Where a window's rows lie: after each `rows` of them `skip` rows of the picture are left out, and the
 * window's height is that of those that are there. 0: they lie together. */
struct strips {
    unsigned rows, skip;
};

/* The part of the window that begins with its row y and whose rows lie together. */
struct window window_strip(struct window window, struct strips strips, unsigned y);

/* The number of such parts. */
unsigned window_strip_count(struct window window, struct strips strips);

/* Linear RGB radiance, row 0 on top, pixel (x, y) channel c at rgb[(y * width + x) * 3 + c]. */
struct image {
    unsigned width, height;
    float *rgb;
    double *rgb64; /* the same before rounding to float, where that is wanted; otherwise NULL */
    float
        *truncation; /* how far a pixel is from the picture with all bounces at most, where wanted; or NULL */
};

/* From linear light to 8-bit code values. */
enum transfer { TRANSFER_SRGB, TRANSFER_LINEAR };

/* What a file says about its picture, as far as its format can: PNG and EXR hold the texts or attributes
 * "scene", "device", "precision" and "maxBounces", EXR also "settings", "digest" and "tile"; PFM holds none.
 * The transfer function matters to PNG alone, the others are linear. A string may be NULL. */
struct image_metadata {
    enum transfer transfer;
    const char *scene, *device, *precision;
    unsigned max_bounces;
    const char *settings; /* of the picture, as options of the command line */
    const char *digest;   /* of the scene with these settings */
    const char *tile;     /* which one of how many parts of what, see tile.h; NULL: none */
    unsigned picture_width,
        picture_height; /* of which the window is a part; 0: the picture is all there is */
    struct window window;
    struct strips strips;
};

/* Where the rows of a picture come from when it is written. */
struct image_rows {
    unsigned width, height;
    bool bounds_truncation; /* has a second kind of rows: bounds on what is cut off, some of them not 0 */
    void *context;

    /* Points to row y, 3 * width values of RGB or width bounds, until the next call. Fails with a status
     * (reported). */
    enum status (*read)(void *context, unsigned y, bool truncation, const float **row);
};

/* A black image; STATUS_UNABLE (reported) if the machine's memory cannot hold it. */
enum status image_create(unsigned width, unsigned height, struct image *image);

/* Gives a black image room for double precision; STATUS_UNABLE (reported) without memory. */
enum status image_widen(struct image *image);
void image_destroy(struct image *image);

enum image_format { IMAGE_FORMAT_UNKNOWN, IMAGE_FORMAT_PNG, IMAGE_FORMAT_EXR, IMAGE_FORMAT_PFM };

/* The format that a path's suffix names, in either case; IMAGE_FORMAT_UNKNOWN (reported) for any other. */
enum image_format image_format_of(const char *path);

/* Writes the picture in the format of the path's suffix, whole or not at all (see output_file.h):
 * .png 8-bit RGB, .exr 32-bit float, ZIP, .pfm 32-bit float. STATUS_REFUSED for an unknown suffix,
 * STATUS_UNABLE where the file cannot be written; both reported. Needs memory for a few rows only. */
enum status image_write(const struct image *image, const char *path, const struct image_metadata *metadata);

/* The same for rows from anywhere; ends with the status of the row that fails. */
enum status image_write_rows(const struct image_rows *rows, const char *path,
                             const struct image_metadata *metadata);

/* Whether image_write() could begin now: known suffix, writable place. Reports and returns as it does. */
enum status image_write_check(const char *path);

#endif
