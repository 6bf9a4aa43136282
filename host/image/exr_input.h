#ifndef VKWHITTED_IMAGE_EXR_INPUT_H
#define VKWHITTED_IMAGE_EXR_INPUT_H

#include "image/image.h"

/* An OpenEXR file that is read row by row. */
struct exr_input;

/* STATUS_UNABLE (reported) where the file cannot be read, STATUS_REFUSED (reported) where it is no EXR file;
 * the path must stay where it is. */
enum status exr_input_open(const char *path, struct exr_input **input);
void exr_input_close(struct exr_input **input);

int exr_input_parts(const struct exr_input *input);

/* A part's data window and the file's display window. False: not of at most 65536 pixels a side from (0, 0)
 * on. */
bool exr_input_windows(const struct exr_input *input, int part, struct window *data, struct window *display);

/* A string attribute of the first part; NULL: there is none. Until the input is closed. */
const char *exr_input_text(const struct exr_input *input, const char *name);

/* A whole number; 0 where there is none. */
int exr_input_number(const struct exr_input *input, const char *name);

/* Row y of a part with a valid data window, y as in that window: the values of the channels with these names
 * (an array that is the same in all calls for a part) side by side for each pixel, until the next call. Half
 * and integer channels are converted. STATUS_REFUSED (reported) where the part has no such channels and rows,
 * or they are damaged. */
enum status exr_input_read(struct exr_input *input, int part, unsigned y, const char *const *channels,
                           int channel_count, const float **row);

#endif
