#include "bench/report.h"

#include <stdlib.h>
#include <string.h>

#include "base/output_file.h"
#include "check/heatmap.h"
#include "image/formats.h"
#include "image/srgb.h"
#include "report_html.h"

/* What is shown of a picture: its colours, or where it differs from another one. */
struct view {
    const struct image *image, *reference;
    struct srgb_encoder encoder;
};

static void encode_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct view *view = context;
    size_t values = (size_t)view->image->width * 3, start = y * values;
    if (!view->reference)
        srgb_encode(&view->encoder, view->image->rgb + start, values, rgb);
    for (size_t i = 0; i < values && view->reference; i += 3)
        heatmap_color(view->image->rgb + start + i, view->reference->rgb + start + i, rgb + i);
}

/* RFC 4648, as a JSON text. NULL without memory. */
static json_t *encode_base64(const char *bytes, size_t count)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t size = (count + 2) / 3 * 4;
    char *text = malloc(size + 1), *end = text;
    for (size_t i = 0; i < count && text; i += 3) {
        size_t here = count - i < 3 ? count - i : 3;
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < here ? (uint8_t)bytes[i + k] : 0);
        for (size_t k = 0; k < 4; ++k)
            *end++ = k <= here ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    json_t *value = text ? json_stringn(text, size) : NULL;
    free(text);
    return value;
}

static enum status add_picture(json_t *pictures, const char *key, const struct view *view)
{
    const struct png_source source = {
        .width = view->image->width,
        .height = view->image->height,
        .transfer = TRANSFER_SRGB,
        .encode_row = encode_row,
        .context = view,
    };
    char *bytes = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&bytes, &size);
    enum status status = stream ? png_encode(&source, stream, "picture of the report") : STATUS_DONE;
    bool complete =
        stream && fclose(stream) == 0 &&
        (status != STATUS_DONE || json_object_set_new(pictures, key, encode_base64(bytes, size)) == 0);
    free(bytes);
    if (complete)
        return status;
    log_error("no memory for a picture of the report");
    return STATUS_UNABLE;
}

enum status report_pictures(const struct image *image, const struct image *reference, json_t **pictures)
{
    struct view view = {.image = image};
    srgb_encoder_init(&view.encoder);
    *pictures = json_object();
    enum status status = add_picture(*pictures, "render", &view);
    view.reference = reference;
    if (status == STATUS_DONE && reference)
        status = add_picture(*pictures, "heatmap", &view);
    if (status != STATUS_DONE) {
        json_decref(*pictures);
        *pictures = NULL;
    }
    return status;
}

enum status report_write(const json_t *document, const char *path)
{
    static const char marker[] = "@BENCH@";
    const char *template = (const char *)report_html, *end = template + sizeof report_html;
    const char *place = memmem(template, sizeof report_html, marker, strlen(marker));
    char *text = json_dumps(document, JSON_ENSURE_ASCII | JSON_REAL_PRECISION(9));
    struct output_file file;
    if (!text || !place) {
        log_error("%s: no memory for the report", path);
        free(text);
        return STATUS_UNABLE;
    }
    enum status status = output_file_open(path, &file);
    if (status == STATUS_DONE) {
        output_file_write(&file, template, (size_t)(place - template));
        /* Texts may hold "</script" and "<!--", which would end or change the element around them. */
        for (size_t at = 0, length; text[at]; at += length + (text[at + length] == '<')) {
            length = strcspn(text + at, "<");
            output_file_write(&file, text + at, length);
            if (text[at + length] == '<')
                output_file_write(&file, "\\u003c", 6);
        }
        place += strlen(marker);
        output_file_write(&file, place, (size_t)(end - place));
        status = output_file_commit(&file);
    }
    free(text);
    return status;
}
