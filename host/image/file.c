#include "image/file.h"

#include <string.h>
#include <strings.h>

#include "base/output_file.h"
#include "image/formats.h"

static const struct {
    const char *suffix;
    enum status (*write)(const struct image *image, const char *path, const struct image_metadata *metadata);
} formats[] = {
    [IMAGE_FORMAT_PNG] = {".png", image_write_png},
    [IMAGE_FORMAT_EXR] = {".exr", image_write_exr},
    [IMAGE_FORMAT_PFM] = {".pfm", image_write_pfm},
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
    if (image_format_of(path) == IMAGE_FORMAT_UNKNOWN)
        return STATUS_REFUSED;
    return output_file_check(path);
}
