#include "image/join.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/exr_input.h"

/* What the file of a tile says. */
struct tile_file {
    const char *path;
    struct tile tile;
    struct window display;
    char *scene, *device, *precision, *settings, *digest;
    unsigned max_bounces;
    bool bounds_truncation;
};

struct join {
    struct tile_file *files; /* once complete, in the order of the tiles */
    size_t count;
    char *devices; /* the different ones */
    float *zeros;  /* a row of bounds of a tile in which all are 0 */
    struct exr_input *input;
    size_t opened; /* the file that it is */
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

/* The parts of the file for strips of colours, and perhaps of bounds, are where the tile's rows are. */
static bool parts_fit(const struct exr_input *input, struct tile_file *file)
{
    struct window window, data;
    struct strips strips;
    if (!tile_rows(&file->tile, &window, &strips))
        return false;
    const unsigned of_a_kind = (window.height + strips.rows - 1) / strips.rows;
    const unsigned parts = (unsigned)exr_input_parts(input);
    file->bounds_truncation = parts == 2 * of_a_kind;
    bool fit = parts == of_a_kind || file->bounds_truncation;
    for (unsigned i = 0; i < parts && fit; ++i)
        fit = exr_input_windows(input, (int)i, &data, &file->display) &&
              same_window(data, window_strip(window, strips, i % of_a_kind * strips.rows));
    return fit;
}

static bool copy_text(const struct exr_input *input, const char *name, char **copy)
{
    const char *text = exr_input_text(input, name);
    *copy = strdup(text ? text : "");
    return *copy;
}

static enum status read_header(const char *path, struct tile_file *file)
{
    struct exr_input *input;
    enum status status = exr_input_open(path, &input);
    if (status != STATUS_DONE)
        return status;
    const char *text = exr_input_text(input, "tile");
    file->path = path;
    file->max_bounces = (unsigned)exr_input_number(input, "maxBounces");
    if (!text || !tile_parse(text, &file->tile) || !parts_fit(input, file)) {
        log_error("%s: expected a tile, as render --tile writes it%s", path,
                  text ? "" : "; this EXR file does not say which one it is");
        status = STATUS_REFUSED;
    } else if (!copy_text(input, "scene", &file->scene) || !copy_text(input, "device", &file->device) ||
               !copy_text(input, "precision", &file->precision) ||
               !copy_text(input, "settings", &file->settings) || !copy_text(input, "digest", &file->digest)) {
        status = no_memory();
    }
    exr_input_close(&input);
    return status;
}

/* Whether it is a tile of the same picture as the first. */
static bool belongs(const struct tile_file *file, const struct tile_file *first)
{
    if (strcmp(file->settings, first->settings) != 0 || !same_window(file->display, first->display) ||
        !same_window(file->tile.whole, first->tile.whole))
        log_error("%s: has other settings than %s: %s, not %s", file->path, first->path, file->settings,
                  first->settings);
    else if (strcmp(file->digest, first->digest) != 0)
        log_error("%s: is of another scene than %s: %s (digest %s), not %s (%s)", file->path, first->path,
                  file->scene, file->digest, first->scene, first->digest);
    else if (file->tile.count != first->tile.count)
        log_error("%s: is one of %u tiles, %s is one of %u", file->path, file->tile.count, first->path,
                  first->tile.count);
    else
        return true;
    return false;
}

/* Names the tiles that have no file: "3, 7-9". */
static void report_missing(const struct tile_file *sorted, unsigned count)
{
    char list[200] = "";
    unsigned missing = 0;
    for (unsigned i = 0, end; i < count; i = end) {
        for (end = i; end < count && !sorted[end].path; ++end)
            ++missing;
        const size_t length = strlen(list);
        if (end - i > 1)
            snprintf(list + length, sizeof list - length, "%s%u-%u", length ? ", " : "", i + 1, end);
        else if (end > i)
            snprintf(list + length, sizeof list - length, "%s%u", length ? ", " : "", end);
        end += end == i;
    }
    const bool cut = strlen(list) + 1 == sizeof list;
    if (missing > 0)
        log_error("%u of %u tiles %s missing: %s%s", missing, count, missing == 1 ? "is" : "are", list,
                  cut ? "..." : "");
}

/* Puts the files in the order of their tiles. */
static enum status sort_files(struct join *join)
{
    const unsigned count = join->files[0].tile.count;
    enum status status = STATUS_DONE;
    struct tile_file *sorted = calloc(count, sizeof *sorted);
    if (!sorted)
        return no_memory();
    for (size_t i = 0; i < join->count; ++i) {
        const struct tile_file *file = &join->files[i];
        if (!belongs(file, &join->files[0])) {
            status = STATUS_REFUSED;
            continue;
        }
        struct tile_file *place = &sorted[file->tile.number - 1];
        if (place->path) {
            log_error("%s and %s are both tile %u of %u", place->path, file->path, file->tile.number, count);
            status = STATUS_REFUSED;
        }
        *place = *file;
    }
    report_missing(sorted, count);
    for (unsigned i = 0; i < count; ++i)
        if (!sorted[i].path)
            status = STATUS_REFUSED;
    if (status == STATUS_DONE)
        memcpy(join->files, sorted, count * sizeof *sorted);
    free(sorted);
    return status;
}

/* "a, b": each device that rendered a tile. */
static enum status list_devices(struct join *join)
{
    size_t room = 1;
    for (size_t i = 0; i < join->count; ++i)
        room += strlen(join->files[i].device) + 2;
    join->devices = calloc(room, 1);
    if (!join->devices)
        return no_memory();
    for (size_t i = 0; i < join->count; ++i)
        if (!strstr(join->devices, join->files[i].device)) {
            strcat(join->devices, join->devices[0] ? ", " : "");
            strcat(join->devices, join->files[i].device);
        }
    return STATUS_DONE;
}

enum status join_create(const char *const *paths, size_t count, struct join **pointer)
{
    struct join *join = *pointer = calloc(1, sizeof *join);
    if (join)
        join->files = calloc(count, sizeof *join->files);
    if (!join || !join->files) {
        join_destroy(pointer);
        return no_memory();
    }
    enum status status = STATUS_DONE;
    for (join->count = 0; join->count < count && status == STATUS_DONE; ++join->count)
        status = read_header(paths[join->count], &join->files[join->count]);
    if (status == STATUS_DONE)
        status = sort_files(join);
    if (status == STATUS_DONE)
        status = list_devices(join);
    if (status == STATUS_DONE) {
        join->zeros = calloc(join->files[0].tile.whole.width, sizeof *join->zeros);
        status = join->zeros ? STATUS_DONE : no_memory();
    }
    if (status != STATUS_DONE)
        join_destroy(pointer);
    return status;
}

void join_destroy(struct join **pointer)
{
    struct join *join = *pointer;
    *pointer = NULL;
    if (!join)
        return;
    for (size_t i = 0; i < join->count; ++i) {
        struct tile_file *file = &join->files[i];
        free(file->scene), free(file->device), free(file->precision), free(file->settings),
            free(file->digest);
    }
    exr_input_close(&join->input);
    free(join->files);
    free(join->devices);
    free(join->zeros);
    free(join);
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
    enum status status = STATUS_DONE;
    if (!join->input || join->opened != index) { /* one at a time: there may be more than can be open */
        exr_input_close(&join->input);
        status = exr_input_open(file->path, &join->input);
        join->opened = index;
    }
    struct window window;
    struct strips strips;
    tile_rows(&file->tile, &window, &strips);
    const unsigned of_a_kind = (window.height + strips.rows - 1) / strips.rows;
    const unsigned part = at / strips.rows + (truncation ? of_a_kind : 0);
    return status == STATUS_DONE ? exr_input_read(join->input, (int)part, file->tile.whole.y + y,
                                                  truncation ? bound : colors, truncation ? 1 : 3, row)
                                 : status;
}

struct image_rows join_rows(struct join *join)
{
    const struct window *whole = &join->files[0].tile.whole;
    struct image_rows rows = {whole->width, whole->height, false, join, read_row};
    for (size_t i = 0; i < join->count; ++i)
        rows.bounds_truncation = rows.bounds_truncation || join->files[i].bounds_truncation;
    return rows;
}

struct image_metadata join_metadata(const struct join *join)
{
    const struct tile_file *first = &join->files[0];
    return (struct image_metadata){
        .scene = first->scene,
        .device = join->devices,
        .precision = first->precision,
        .max_bounces = first->max_bounces,
        .settings = first->settings,
        .digest = first->digest,
        .picture_width = first->display.width,
        .picture_height = first->display.height,
        .window = first->tile.whole,
    };
}
