#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/output_file.h"
#include "image/formats.h"

/* Paul Debevec's PFM format: https://www.pauldebevec.com/Research/HDR/PFM/. The sign of the scale says the
 * byte order: negative is little-endian. Rows run from bottom to top. */
static enum status write_pfm(const struct image_rows *rows, const char *path,
                             const struct image_metadata *metadata)
{
    (void)metadata;
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    const char *scale = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "-1.0" : "1.0";
    fprintf(file.stream, "PF\n%u %u\n%s\n", rows->width, rows->height, scale);
    const float *row;
    for (unsigned y = rows->height; y-- > 0 && status == STATUS_DONE;) {
        status = rows->read(rows->context, y, false, &row);
        if (status == STATUS_DONE)
            fwrite(row, sizeof *row, (size_t)rows->width * 3, file.stream);
    }
    if (status == STATUS_DONE)
        return output_file_commit(&file);
    output_file_abandon(&file);
    return status;
}

static const struct {
    const char *suffix;
    enum status (*write)(const struct image_rows *rows, const char *path,
                         const struct image_metadata *metadata);
} formats[] = {
    [IMAGE_FORMAT_PNG] = {".png", image_write_png},
    [IMAGE_FORMAT_EXR] = {".exr", image_write_exr},
    [IMAGE_FORMAT_PFM] = {".pfm", write_pfm},
};

enum image_format image_format_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *suffix = strrchr(slash ? slash : path, '.');
    for (int i = IMAGE_FORMAT_PNG; suffix && i <= IMAGE_FORMAT_PFM; i++)
        if (strcasecmp(suffix, formats[i].suffix) == 0)
            return (enum image_format)i;
    log_error("%s: a picture's name must end in .png, .exr or .pfm, %s%s%s", path,
              suffix ? "not \"" : "this one has no suffix", suffix ? suffix : "", suffix ? "\"" : "");
    return IMAGE_FORMAT_UNKNOWN;
}

enum status image_write_rows(const struct image_rows *rows, const char *path,
                             const struct image_metadata *metadata)
{
    enum image_format format = image_format_of(path);
    return format == IMAGE_FORMAT_UNKNOWN ? STATUS_REFUSED : formats[format].write(rows, path, metadata);
}

static enum status read_row(void *context, unsigned y, bool truncation, const float **row)
{
    const struct image *image = context;
    *row =
        truncation ? image->truncation + (size_t)y * image->width : image->rgb + (size_t)y * image->width * 3;
    return STATUS_DONE;
}

enum status image_write(const struct image *image, const char *path, const struct image_metadata *metadata)
{
    struct image source = *image;
    struct image_rows rows = {image->width, image->height, false, &source, read_row};
    const size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; image->truncation && i < pixels && !rows.bounds_truncation; ++i)
        rows.bounds_truncation = image->truncation[i] != 0;
    return image_write_rows(&rows, path, metadata);
}

enum status image_write_check(const char *path)
{
    return image_format_of(path) == IMAGE_FORMAT_UNKNOWN ? STATUS_REFUSED : output_file_claim(path);
}
