#include <stdlib.h>
#include <string.h>

#include "base/output_file.h"
#include "bench/document.h"
#include "check/heatmap.h"
#include "image/formats.h"
#include "image/srgb.h"
#include "report_html.h"

/* What is shown of a picture: its colours, or where it differs from another one. */
struct view {
    const struct image *image, *reference;
    struct srgb_encoder encoder;
};

static enum status encode_row(const void *context, unsigned y, uint8_t *rgb)
{
    const struct view *view = context;
    size_t values = (size_t)view->image->width * 3, start = y * values;
    if (!view->reference)
        srgb_encode(&view->encoder, view->image->rgb + start, values, rgb);
    for (size_t i = 0; i < values && view->reference; i += 3)
        heatmap_color(view->image->rgb + start + i, view->reference->rgb + start + i, rgb + i);
    return STATUS_DONE;
}

/* RFC 4648, as a JSON text. A byte of 0 stands behind the bytes. NULL without memory. */
static json_t *encode_base64(const char *bytes, size_t count)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t size = (count + 2) / 3 * 4;
    char *text = malloc(size + 1);
    for (size_t i = 0; i < size && text; ++i) {
        size_t at = 6 * i / 8;
        unsigned pair = at < count ? (unsigned)(uint8_t)bytes[at] << 8 | (uint8_t)bytes[at + 1] : 0;
        text[i] = at < count ? letters[pair >> (10 - 6 * i % 8) & 63] : '=';
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
    return status;
}

/* Texts may hold "</script" and "<!--", which would end or change the element around them. */
static int write_escaped(const char *text, size_t size, void *stream)
{
    for (size_t i = 0; i < size; ++i)
        fputs(text[i] == '<' ? "\\u003c" : (char[]){text[i], '\0'}, stream);
    return 0;
}

enum status report_write(const json_t *document, const char *path)
{
    static const char marker[] = "@BENCH@";
    const char *template = (const char *)report_html, *end = template + sizeof report_html;
    const char *place = memmem(template, sizeof report_html, marker, strlen(marker));
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    output_file_write(&file, template, (size_t)(place - template));
    if (json_dump_callback(document, write_escaped, file.stream,
                           JSON_ENSURE_ASCII | JSON_REAL_PRECISION(9)) != 0) {
        output_file_abandon(&file);
        log_error("%s: no memory for the report", path);
        return STATUS_UNABLE;
    }
    place += strlen(marker);
    output_file_write(&file, place, (size_t)(end - place));
    return output_file_commit(&file);
}
