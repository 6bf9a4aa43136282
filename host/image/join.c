#include "image/join.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/exr_error.h"
#include "image/exr_input.h"
#include "image/tile.h"

enum text { SCENE, DEVICE, PRECISION, SETTINGS, DIGEST, TEXTS };

/* What the file of a tile says. */
struct tile_file {
    const char *path; /* NULL: the tile is missing */
    struct tile tile;
    struct window display;
    char *texts[TEXTS];
    int32_t max_bounces;
    bool bounds_truncation;
};

/* The files of all tiles, in their order, while they are read. */
struct join {
    const struct tile_file *files;
    float *zeros;           /* a row of bounds of a tile in which all are 0 */
    struct exr_input input; /* one at a time: there may be more files than can be open */
    size_t opened;          /* the one that it is */
};

static enum status no_memory(void)
{
    log_error("no memory to join tiles");
    return STATUS_UNABLE;
}

static bool same_window(struct window a, struct window b)
{
    return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
}

/* A string attribute; NULL: there is none. Until the input is closed. */
static const char *get_text(const struct exr_input *input, const char *name)
{
    const exr_attribute_t *attribute;
    return exr_get_attribute_by_name(input->context, 0, name, &attribute) == EXR_ERR_SUCCESS &&
                   attribute->type == EXR_ATTR_STRING
               ? attribute->string->str
               : NULL;
}

/* Whether the file's parts are where the tile's rows are. */
static bool parts_fit(const struct exr_input *input, struct tile_file *file)
{
    struct window window, data;
    struct strips strips;
    int parts;
    if (!tile_rows(&file->tile, &window, &strips) || !exr_succeeded(exr_get_count(input->context, &parts)))
        return false;
    const int of_a_kind = (int)window_strip_count(window, strips); /* of colours, and perhaps of bounds */
    file->bounds_truncation = parts == 2 * of_a_kind;
    bool fit = parts == of_a_kind || file->bounds_truncation;
    for (int i = 0; i < parts && fit; ++i)
        fit = exr_input_windows(input, i, &data, &file->display) &&
              same_window(data, window_strip(window, strips, (unsigned)(i % of_a_kind) * strips.rows));
    return fit;
}

/* The file's texts are the caller's to free, also on failure. */
static enum status read_header(const char *path, struct tile_file *file)
{
    static const char *const names[TEXTS] = {"scene", "device", "precision", "settings", "digest"};
    struct exr_input input;
    enum status status = exr_input_open(path, &input);
    const char *tile = status == STATUS_DONE ? get_text(&input, "tile") : NULL;
    file->path = path;
    if (status == STATUS_DONE && !(tile && tile_parse(tile, &file->tile) && parts_fit(&input, file))) {
        log_error("%s: expected a tile, as render --tile writes it%s", path,
                  tile ? "" : "; this EXR file does not say which one it is");
        status = STATUS_REFUSED;
    }
    if (status == STATUS_DONE)
        exr_attr_get_int(input.context, 0, "maxBounces", &file->max_bounces);
    for (int i = 0; i < TEXTS && status == STATUS_DONE; ++i) {
        const char *text = get_text(&input, names[i]);
        file->texts[i] = strdup(text ? text : "");
        status = file->texts[i] ? STATUS_DONE : no_memory();
    }
    exr_input_close(&input);
    return status;
}

/* Whether it is a tile of the same picture as the first. */
static bool belongs(const struct tile_file *file, const struct tile_file *first)
{
    char *const *texts = file->texts, *const *expected = first->texts;
    if (strcmp(texts[SETTINGS], expected[SETTINGS]) != 0 || !same_window(file->display, first->display) ||
        !same_window(file->tile.whole, first->tile.whole))
        log_error("%s: has other settings than %s: %s, not %s", file->path, first->path, texts[SETTINGS],
                  expected[SETTINGS]);
    else if (strcmp(texts[DIGEST], expected[DIGEST]) != 0)
        log_error("%s: is of another scene than %s: %s (digest %s), not %s (%s)", file->path, first->path,
                  texts[SCENE], texts[DIGEST], expected[SCENE], expected[DIGEST]);
    else if (file->tile.count != first->tile.count)
        log_error("%s: is one of %u tiles, %s is one of %u", file->path, file->tile.count, first->path,
                  first->tile.count);
    else
        return true;
    return false;
}

/* Names the tiles that have no file: "3, 7-9". */
static bool report_missing(const struct tile_file *sorted, unsigned count)
{
    char list[200] = "";
    unsigned missing = 0;
    for (unsigned i = 0, end; i < count; i = end + 1) {
        for (end = i; end < count && !sorted[end].path; ++end)
            ++missing;
        const size_t length = strlen(list);
        const char *comma = length > 0 ? ", " : "";
        if (end - i > 1)
            snprintf(list + length, sizeof list - length, "%s%u-%u", comma, i + 1, end);
        else if (end > i)
            snprintf(list + length, sizeof list - length, "%s%u", comma, end);
    }
    if (missing > 0)
        log_error("%u of %u tiles %s missing: %s%s", missing, count, missing == 1 ? "is" : "are", list,
                  strlen(list) + 1 == sizeof list ? "..." : "");
    return missing > 0;
}

/* Puts the files in the order of their tiles, of which there is room for all. */
static enum status sort_files(const struct tile_file *files, size_t count, struct tile_file *sorted)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < count; ++i) {
        struct tile_file *place = &sorted[files[i].tile.number - 1];
        if (!belongs(&files[i], &files[0])) {
            status = STATUS_REFUSED;
            continue;
        }
        if (place->path) {
            log_error("%s and %s are both tile %u of %u", place->path, files[i].path, place->tile.number,
                      place->tile.count);
            status = STATUS_REFUSED;
        }
        *place = files[i];
    }
    return report_missing(sorted, files[0].tile.count) ? STATUS_REFUSED : status;
}

/* "a, b": each device that rendered a tile; to be freed. NULL without memory. */
static char *list_devices(const struct tile_file *files, size_t count)
{
    size_t room = 1;
    for (size_t i = 0; i < count; ++i)
        room += strlen(files[i].texts[DEVICE]) + 2;
    char *list = calloc(room, 1);
    for (size_t i = 0; i < count && list; ++i)
        if (!strstr(list, files[i].texts[DEVICE])) {
            strcat(list, *list ? ", " : "");
            strcat(list, files[i].texts[DEVICE]);
        }
    return list;
}

static enum status read_row(void *context, unsigned y, bool truncation, const float **row)
{
    static const char *const colors[] = {"R", "G", "B"}, *const bound[] = {"truncation_bound"};
    struct join *join = context;
    unsigned at;
    const size_t index = tile_of_row(&join->files[0].tile, y, &at) - 1;
    const struct tile_file *file = &join->files[index];
    if (truncation && !file->bounds_truncation) {
        *row = join->zeros;
        return STATUS_DONE;
    }
    if (!join->input.context || join->opened != index) {
        exr_input_close(&join->input);
        enum status status = exr_input_open(file->path, &join->input);
        if (status != STATUS_DONE)
            return status;
        join->opened = index;
    }
    struct window window;
    struct strips strips;
    tile_rows(&file->tile, &window, &strips);
    const unsigned part = at / strips.rows + (truncation ? window_strip_count(window, strips) : 0);
    return exr_input_read(&join->input, (int)part, (int)(file->tile.whole.y + y), truncation ? bound : colors,
                          truncation ? 1 : 3, row);
}

static enum status write_outputs(const struct tile_file *files, const char *const *outputs,
                                 size_t output_count, enum transfer transfer)
{
    const struct tile_file *first = &files[0];
    const struct window whole = first->tile.whole;
    char *devices = list_devices(files, first->tile.count);
    struct join join = {.files = files, .zeros = calloc(whole.width, sizeof *join.zeros)};
    struct image_rows rows = {whole.width, whole.height, false, &join, read_row};
    const struct image_metadata metadata = {
        .transfer = transfer,
        .scene = first->texts[SCENE],
        .device = devices,
        .precision = first->texts[PRECISION],
        .max_bounces = (unsigned)first->max_bounces,
        .settings = first->texts[SETTINGS],
        .digest = first->texts[DIGEST],
        .picture_width = first->display.width,
        .picture_height = first->display.height,
        .window = whole,
    };
    for (unsigned i = 0; i < first->tile.count; ++i)
        rows.bounds_truncation = rows.bounds_truncation || files[i].bounds_truncation;
    const bool ready = devices && join.zeros;
    enum status status = ready ? STATUS_DONE : no_memory();
    for (size_t i = 0; i < output_count && ready; ++i)
        status = status_worse(status, image_write_rows(&rows, outputs[i], &metadata));
    if (status == STATUS_DONE)
        log_notice("%ux%u from %u tiles", rows.width, rows.height, first->tile.count);
    exr_input_close(&join.input);
    free(join.zeros);
    free(devices);
    return status;
}

enum status join_tiles(const char *const *paths, size_t count, const char *const *outputs,
                       size_t output_count, enum transfer transfer)
{
    struct tile_file *files = calloc(count, sizeof *files), *sorted = NULL;
    enum status status = files ? STATUS_DONE : no_memory();
    for (size_t i = 0; i < count && status == STATUS_DONE; ++i)
        status = read_header(paths[i], &files[i]);
    if (status == STATUS_DONE) {
        sorted = calloc(files[0].tile.count, sizeof *sorted);
        status = sorted ? sort_files(files, count, sorted) : no_memory();
    }
    if (status == STATUS_DONE)
        status = write_outputs(sorted, outputs, output_count, transfer);
    for (size_t i = 0; i < count && files; ++i)
        for (int text = 0; text < TEXTS; ++text)
            free(files[i].texts[text]);
    free(files);
    free(sorted);
    return status;
}
