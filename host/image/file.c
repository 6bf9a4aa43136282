#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/output_file.h"
#include "image/formats.h"

/* Paul Debevec's PFM format: https://www.pauldebevec.com/Research/HDR/PFM/. The sign of the scale says the
 * byte order: negative is little-endian. Rows run from bottom to top. */
static enum status write_pfm(const struct image *image, const char *path,
                             const struct image_metadata *metadata)
{
    (void)metadata;
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    const char *scale = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "-1.0" : "1.0";
    fprintf(file.stream, "PF\n%u %u\n%s\n", image->width, image->height, scale);
    size_t row_channels = (size_t)image->width * 3;
    for (unsigned y = image->height; y-- > 0;)
        output_file_write(&file, image->rgb + y * row_channels, row_channels * sizeof(float));
    return output_file_commit(&file);
}

static const struct {
    const char *suffix;
    enum status (*write)(const struct image *image, const char *path, const struct image_metadata *metadata);
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

enum status image_write(const struct image *image, const char *path, const struct image_metadata *metadata)
{
    enum image_format format = image_format_of(path);
    return format == IMAGE_FORMAT_UNKNOWN ? STATUS_REFUSED : formats[format].write(image, path, metadata);
}

enum status image_write_check(const char *path)
{
    return image_format_of(path) == IMAGE_FORMAT_UNKNOWN ? STATUS_REFUSED : output_file_claim(path);
}
