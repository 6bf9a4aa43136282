#include "bench/pictures.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check/heatmap.h"
#include "image/file.h"

/* RFC 4648. NULL without memory. */
static char *encode_base64(const uint8_t *bytes, size_t count)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = malloc((count + 2) / 3 * 4 + 1), *end = text;
    for (size_t i = 0; i < count && text; i += 3) {
        size_t here = count - i < 3 ? count - i : 3;
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < here ? bytes[i + k] : 0);
        for (size_t k = 0; k < 4; ++k)
            *end++ = k <= here ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    if (text)
        *end = '\0';
    return text;
}

static json_t *read_as_base64(const char *path)
{
    json_t *value = NULL;
    FILE *file = fopen(path, "rbe");
    if (!file || fseek(file, 0, SEEK_END) != 0) {
        log_error("%s: %s", path, strerror(errno));
    } else {
        long size = ftell(file);
        uint8_t *bytes = size > 0 ? malloc((size_t)size) : NULL;
        rewind(file);
        char *text = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size
                         ? encode_base64(bytes, (size_t)size)
                         : NULL;
        value = text ? json_string(text) : NULL;
        if (!value)
            log_error("%s: cannot read the picture back, or no memory for it", path);
        free(text);
        free(bytes);
    }
    if (file)
        fclose(file);
    return value;
}

/* Puts the file, if it was written, into the object and removes it. */
static enum status take(enum status written, const char *path, json_t *pictures, const char *key)
{
    if (written != STATUS_DONE)
        return written;
    json_t *value = read_as_base64(path);
    unlink(path);
    return value && json_object_set_new(pictures, key, value) == 0 ? STATUS_DONE : STATUS_UNABLE;
}

enum status bench_pictures(const struct image *image, const struct image *reference, json_t **pictures)
{
    const char *root = getenv("TMPDIR");
    char folder[512], path[600];
    snprintf(folder, sizeof folder, "%.480s/vkwhitted-XXXXXX", root && *root ? root : "/tmp");
    *pictures = NULL;
    if (!mkdtemp(folder)) {
        log_error("%s: cannot make a folder for pictures: %s", folder, strerror(errno));
        return STATUS_UNABLE;
    }
    *pictures = json_object();
    snprintf(path, sizeof path, "%s/picture.png", folder);
    enum status status =
        take(image_write(image, path, &(struct image_metadata){0}), path, *pictures, "render");
    if (status == STATUS_DONE && reference)
        status = take(heatmap_write(image, reference, path), path, *pictures, "heatmap");
    rmdir(folder);
    if (status != STATUS_DONE) {
        json_decref(*pictures);
        *pictures = NULL;
    }
    return status;
}
