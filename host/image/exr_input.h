#ifndef VKWHITTED_IMAGE_EXR_INPUT_H
#define VKWHITTED_IMAGE_EXR_INPUT_H

#include <openexr.h>
#include <stdint.h>

#include "image/image.h"

/* An OpenEXR file that is read row by row, from scan lines or tiles. All 0: none is open. */
struct exr_input {
    const char *path; /* the caller keeps it alive */
    exr_context_t context;

    /* The rows that were decoded last: a chunk of scan lines, or a row of tiles. */
    int part, first, count; /* rows first to first + count - 1 of that part */
    size_t width;
    const char *const *channels; /* that values holds, side by side for each pixel */
    int channel_count;
    float *values;
    size_t room; /* for values */
};

/* Opens the file; the input stays where it is. STATUS_UNABLE (reported) where the file cannot be read,
 * STATUS_REFUSED (reported) where it is no EXR file. */
enum status exr_input_open(const char *path, struct exr_input *input);

/* Does nothing to one that is not open. */
void exr_input_close(struct exr_input *input);

/* A part's data window and the file's display window. False: not of at most 65536 pixels a side from (0, 0)
 * on. */
bool exr_input_windows(const struct exr_input *input, int part, struct window *data, struct window *display);

/* Row y of a part, y as in its data window, which is not larger than memory allows: the values of the
 * channels with these names (an array that is the same in all calls for a part) side by side for each pixel,
 * until the next call. Half and integer channels are converted. STATUS_REFUSED (reported) where the part has
 * no such channels and rows, or they are damaged. */
enum status exr_input_read(struct exr_input *input, int part, int y, const char *const *channels,
                           int channel_count, const float **row);

#endif
