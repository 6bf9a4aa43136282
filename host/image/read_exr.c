#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "image/exr_error.h"
#include "image/exr_input.h"
#include "image/formats.h"

static const char *const rgb[] = {"R", "G", "B"};

/* Says why the file is refused. */
__attribute__((format(printf, 2, 3))) static enum status refuse(const struct exr_input *input,
                                                                const char *format, ...)
{
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    log_error("%s: cannot read EXR: %s", input->path, message);
    return STATUS_REFUSED;
}

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; ++i)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return &list->entries[i];
    return NULL;
}

static enum status check_channels(const struct exr_input *input, bool is_half[3])
{
    const exr_attr_chlist_t *list;
    if (!exr_succeeded(exr_get_channels(input->context, 0, &list)))
        return refuse(input, "%s", exr_error());
    for (int c = 0; c < 3; ++c) {
        const exr_attr_chlist_entry_t *channel = find_channel(list, rgb[c]);
        if (!channel)
            return refuse(input, "expected the channels R, G and B, has no %s", rgb[c]);
        if (channel->pixel_type == EXR_PIXEL_UINT || channel->x_sampling != 1 || channel->y_sampling != 1)
            return refuse(input, "channel %s: expected half or float for each pixel", rgb[c]);
        is_half[c] = channel->pixel_type == EXR_PIXEL_HALF;
    }
    return STATUS_DONE;
}

static enum status check_windows(const struct exr_input *input, const struct window *wanted,
                                 exr_attr_box2i_t *data)
{
    exr_attr_box2i_t display;
    if (!exr_succeeded(exr_get_data_window(input->context, 0, data)) ||
        !exr_succeeded(exr_get_display_window(input->context, 0, &display)))
        return refuse(input, "%s", exr_error());
    const exr_attr_v2i_t first = data->min, last = data->max;
    if (memcmp(data, &display, sizeof display) == 0 ||
        ((int64_t)first.x - display.min.x == wanted->x && (int64_t)first.y - display.min.y == wanted->y))
        return STATUS_DONE;
    return refuse(
        input,
        "its data window (%d, %d)..(%d, %d) is not its display window (%d, %d)..(%d, %d), and not the part "
        "that is judged",
        first.x, first.y, last.x, last.y, display.min.x, display.min.y, display.max.x, display.max.y);
}

static enum status check_compression(const struct exr_input *input)
{
    exr_compression_t compression;
    if (!exr_succeeded(exr_get_compression(input->context, 0, &compression)))
        return refuse(input, "%s", exr_error());
    return compression <= EXR_COMPRESSION_PIZ
               ? STATUS_DONE
               : refuse(input, "compressed with loss: by how much its values are off is not known");
}

/* What a 16-bit float (1 + 5 + 10 bits, IEEE 754) may have been rounded from. */
static struct value_range of_half(float value)
{
    const float size = fabsf(value);
    if (!isfinite(value))
        return isnan(value) ? (struct value_range){value, value}
                            : (struct value_range){value < 0 ? value : 65504, value < 0 ? -65504 : value};
    const float half_step = ldexpf(1, (size < 0x1p-14f ? -14 : ilogbf(size)) - 11);
    return (struct value_range){value - half_step, value + half_step};
}

static enum status read_rows(struct exr_input *input, const bool is_half[3], int first_y,
                             struct read_image *picture)
{
    struct value_range *range = picture->rgb;
    for (unsigned y = 0; y < picture->height; ++y) {
        const float *row;
        const enum status status = exr_input_read(input, 0, first_y + (int)y, rgb, 3, &row);
        if (status != STATUS_DONE)
            return status;
        for (size_t i = 0; i < 3 * (size_t)picture->width; ++i)
            *range++ = is_half[i % 3] ? of_half(row[i]) : (struct value_range){row[i], row[i]};
    }
    return STATUS_DONE;
}

static enum status read(const struct read_input *input, struct exr_input *exr, struct read_image *picture)
{
    exr_attr_box2i_t data;
    bool is_half[3];
    enum status status = check_windows(exr, &input->wanted->window, &data);
    if (status == STATUS_DONE)
        status = read_image_create(input, (unsigned long)((int64_t)data.max.x - data.min.x + 1),
                                   (unsigned long)((int64_t)data.max.y - data.min.y + 1), picture);
    if (status == STATUS_DONE)
        status = check_compression(exr);
    if (status == STATUS_DONE)
        status = check_channels(exr, is_half);
    return status == STATUS_DONE ? read_rows(exr, is_half, data.min.y, picture) : status;
}

enum status image_read_exr(const struct read_input *input, struct read_image *picture)
{
    struct exr_input exr;
    enum status status = exr_input_open(input->path, &exr);
    if (status == STATUS_DONE)
        status = read(input, &exr, picture);
    exr_input_close(&exr);
    return status;
}
