#include "scene/npy.h"

#include <endian.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/progress.h"
#include "base/text_file.h"
#include "scene/scene.h"

enum { PIECE = 1 << 20 }; /* bytes that are read at a time, a multiple of the size of a row */

struct reading {
    int file;
    const struct npy_column *columns;
    struct npy_header header;
    float (*rows)[NPY_COLUMNS];
    size_t row, column; /* of the next value */
    char *message;
};

static enum status refuse_errno(char message[NPY_MESSAGE])
{
    const int error = errno;
    npy_refuse(message, "%s", input_file_problem(error));
    return input_file_status(error);
}

static double decode(const unsigned char *bytes, const struct npy_header *header)
{
    if (header->value_size == sizeof(float)) {
        uint32_t bits;
        float value;
        memcpy(&bits, bytes, sizeof bits);
        bits = header->big_endian ? be32toh(bits) : le32toh(bits);
        memcpy(&value, &bits, sizeof value);
        return (double)value;
    }
    uint64_t bits;
    double value;
    memcpy(&bits, bytes, sizeof bits);
    bits = header->big_endian ? be64toh(bits) : le64toh(bits);
    memcpy(&value, &bits, sizeof value);
    return value;
}

static enum status refuse_value(const struct reading *reading, double value)
{
    const struct npy_column *column = &reading->columns[reading->column];
    const char *rule = !isfinite(value)                           ? "a finite number"
                       : column->bounds->positive && !(value > 0) ? "> 0"
                                                                  : column->bounds->rule;
    return npy_refuse(reading->message, "row %zu: %s must be %s, is %.9g", reading->row, column->name, rule,
                      value);
}

/* Takes the values of a piece. */
static enum status take_values(struct reading *reading, const unsigned char *bytes, size_t size)
{
    const struct npy_header *header = &reading->header;
    for (const unsigned char *end = bytes + size; bytes < end; bytes += header->value_size) {
        const struct bounds *bounds = reading->columns[reading->column].bounds;
        double value = decode(bytes, header);
        if (!(value >= bounds->least && value <= bounds->most)) /* so is what is no number */
            return refuse_value(reading, value);
        reading->rows[reading->row][reading->column] = (float)value;
        size_t *inner = header->columns_first ? &reading->row : &reading->column;
        size_t *outer = header->columns_first ? &reading->column : &reading->row;
        if (++*inner == (header->columns_first ? header->rows : NPY_COLUMNS)) {
            *inner = 0;
            ++*outer;
        }
    }
    return STATUS_DONE;
}

static enum status read_values(struct reading *reading)
{
    size_t left = reading->header.rows * NPY_COLUMNS * reading->header.value_size;
    unsigned char *piece = malloc(PIECE);
    enum status status = STATUS_DONE;
    struct progress progress;
    progress_start(&progress, "reading spheres", left, false);
    if (!piece || !reading->rows) {
        npy_refuse(reading->message, "no memory for %zu spheres", reading->header.rows);
        status = STATUS_UNABLE;
    }
    while (left > 0 && status == STATUS_DONE) {
        size_t size = left < PIECE ? left : PIECE;
        ssize_t got = input_file_read(reading->file, piece, size);
        left -= size;
        if (got < 0)
            status = refuse_errno(reading->message);
        else if ((size_t)got < size)
            status = npy_refuse(reading->message, "is truncated: it became shorter while it was read");
        else
            status = take_values(reading, piece, size);
        progress_advance(&progress, size);
    }
    progress_end(&progress);
    free(piece);
    return status;
}

/* Whether the file has as many bytes as its header says. */
static enum status check_size(const struct npy_header *header, size_t size, char message[NPY_MESSAGE])
{
    size_t row_size = NPY_COLUMNS * header->value_size;
    size_t expected = header->size + header->rows * row_size;
    if (size < expected)
        return npy_refuse(message, "is truncated: its header says %zu rows, it ends in row %zu", header->rows,
                          size > header->size ? (size - header->size) / row_size : 0);
    if (size > expected)
        return npy_refuse(message, "is longer than its header says: %zu bytes behind row %zu of %zu",
                          size - expected, header->rows - (header->rows > 0), header->rows);
    return STATUS_DONE;
}

static enum status read_header(struct reading *reading, size_t size, size_t most_rows)
{
    char text[NPY_MOST_HEADER];
    ssize_t got = input_file_read(reading->file, text, sizeof text);
    if (got < 0)
        return refuse_errno(reading->message);
    enum status status = npy_header_parse(text, (size_t)got, &reading->header, reading->message);
    if (status != STATUS_DONE)
        return status;
    const struct npy_header *header = &reading->header;
    if (header->rows > most_rows)
        return npy_refuse(reading->message, "has %zu rows; a scene may have %d spheres in all", header->rows,
                          SCENE_MAX_SPHERES);
    if (lseek(reading->file, (off_t)header->size, SEEK_SET) < 0)
        return refuse_errno(reading->message);
    return check_size(header, size, reading->message);
}

enum status npy_read(const char *path, const struct npy_column columns[NPY_COLUMNS], size_t most_rows,
                     float (**rows)[NPY_COLUMNS], size_t *row_count, char message[NPY_MESSAGE])
{
    struct reading reading = {.columns = columns, .message = message};
    off_t size = 0;
    reading.file = input_file_open(path, true, &size);
    enum status status = reading.file < 0 ? refuse_errno(message) : STATUS_DONE;
    if (status == STATUS_DONE)
        status = read_header(&reading, (size_t)size, most_rows);
    if (status == STATUS_DONE) {
        reading.rows = malloc((reading.header.rows + 1) * sizeof *reading.rows);
        status = read_values(&reading);
    }
    if (reading.file >= 0)
        close(reading.file);
    if (status != STATUS_DONE) {
        free(reading.rows);
        reading.rows = NULL;
    }
    *rows = reading.rows;
    *row_count = reading.rows ? reading.header.rows : 0;
    return status;
}
