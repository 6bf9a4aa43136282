#include "image/file.h"

#include <string.h>
#include <strings.h>

#include "base/output_file.h"
#include "image/formats.h"

enum image_format image_format_of(const char *path)
{
    static const struct {
        const char *suffix;
        enum image_format format;
    } formats[] = {
        {".png", IMAGE_FORMAT_PNG},
        {".exr", IMAGE_FORMAT_EXR},
        {".pfm", IMAGE_FORMAT_PFM},
    };
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *suffix = strrchr(name, '.');
    for (size_t i = 0; suffix && i < sizeof formats / sizeof formats[0]; i++)
        if (strcasecmp(suffix, formats[i].suffix) == 0)
            return formats[i].format;
    log_error("%s: a picture's name must end in .png, .exr or .pfm, %s%s%s", path,
              suffix ? "not \"" : "this one has no suffix", suffix ? suffix : "", suffix ? "\"" : "");
    return IMAGE_FORMAT_UNKNOWN;
}

enum status image_write(const struct image *image, const char *path, const struct image_metadata *metadata)
{
    switch (image_format_of(path)) {
    case IMAGE_FORMAT_PNG:
        return image_write_png(image, path, metadata);
    case IMAGE_FORMAT_EXR:
        return image_write_exr(image, path, metadata);
    case IMAGE_FORMAT_PFM:
        return image_write_pfm(image, path, metadata);
    case IMAGE_FORMAT_UNKNOWN:
        break;
    }
    return STATUS_REFUSED;
}

enum status image_write_check(const char *path)
{
    if (image_format_of(path) == IMAGE_FORMAT_UNKNOWN)
        return STATUS_REFUSED;
    return output_file_check(path);
}
