#include "scene/npy.h"

#include <endian.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"
#include "base/progress.h"
#include "base/text_file.h"
#include "scene/scene.h"

enum {
    PIECE = 1 << 20,   /* bytes that are read at a time, a multiple of the size of a row */
    MOST_HEADER = 4096 /* bytes; numpy.save() writes 128 for such an array */
};

/* So few that their bytes are no more than PTRDIFF_MAX. */
static const unsigned long most_rows_in_header = 1UL << 48;

/* What stands before the values. */
struct header {
    size_t size; /* of the header, bytes */
    size_t rows;
    size_t value_size; /* 4: float32, 8: float64 */
    bool big_endian, columns_first;
};

struct reading {
    int file;
    const struct npy_column *columns;
    struct header header;
    float (*rows)[NPY_COLUMNS];
    size_t row, column; /* of the next value */
    char *message;
};

/* Writes the message; returns STATUS_REFUSED. */
__attribute__((format(printf, 2, 3))) static enum status refuse(char message[NPY_MESSAGE], const char *format,
                                                                ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, NPY_MESSAGE, format, arguments);
    va_end(arguments);
    return STATUS_REFUSED;
}

static enum status refuse_errno(char message[NPY_MESSAGE])
{
    const int error = errno;
    refuse(message, "%s", input_file_problem(error));
    return input_file_status(error);
}

static double decode(const unsigned char *bytes, const struct header *header)
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
    return refuse(reading->message, "row %zu: %s must be %s, is %.9g", reading->row, column->name, rule,
                  value);
}

/* Takes the values of a piece. */
static enum status take_values(struct reading *reading, const unsigned char *bytes, size_t size)
{
    const struct header *header = &reading->header;
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
        refuse(reading->message, "no memory for %zu spheres", reading->header.rows);
        status = STATUS_UNABLE;
    }
    while (left > 0 && status == STATUS_DONE) {
        size_t size = left < PIECE ? left : PIECE;
        ssize_t got = input_file_read(reading->file, piece, size);
        left -= size;
        if (got < 0)
            status = refuse_errno(reading->message);
        else if ((size_t)got < size)
            status = refuse(reading->message, "is truncated: it became shorter while it was read");
        else
            status = take_values(reading, piece, size);
        progress_advance(&progress, size);
    }
    progress_end(&progress);
    free(piece);
    return status;
}

/* Reads {'descr': '<f4', 'fortran_order': False, 'shape': (17, 4), }, a Python dictionary as numpy.save() and
 * others write it; there may be more blanks or fewer. */
static enum status parse_dictionary(const char *text, struct header *header, char message[NPY_MESSAGE])
{
    static const char expected_type[] = "its dtype must be float32 or float64";
    char type[16] = "", order[6] = "", row_count[24] = "";
    int type_at = 0, shape_at = 0, columns_end = 0;
    unsigned long rows;
    sscanf(text, " { 'descr' : %n", &type_at);
    if (type_at > 0 && text[type_at] == '[') /* structured */
        return refuse(message, "%s, is %.*s", expected_type, (int)strcspn(text + type_at, "]") + 1,
                      text + type_at);
    sscanf(text + type_at, "'%15[^']' , 'fortran_order' : %5[A-Za-z] , 'shape' : (%n", type, order,
           &shape_at);
    header->columns_first = strcmp(order, "True") == 0;
    if (shape_at == 0 || !(header->columns_first || strcmp(order, "False") == 0))
        return refuse(message, "its NumPy header must be a dictionary of 'descr', 'fortran_order' and "
                               "'shape', in this order");
    if (strchr("|<>=", type[0]) && type[1] == 'O')
        return refuse(message, "holds pickled Python objects, which are not read");
    if (strcmp(type, "<f4") && strcmp(type, ">f4") && strcmp(type, "<f8") && strcmp(type, ">f8"))
        return refuse(message, "%s, is '%s'", expected_type, type);
    header->big_endian = type[0] == '>';
    header->value_size = type[2] == '4' ? 4 : 8;
    const char *shape = text + type_at + shape_at; /* behind the parenthesis */
    sscanf(shape, " %23[0-9] , 4%n", row_count, &columns_end);
    if (columns_end == 0 || shape[columns_end + (int)strspn(shape + columns_end, " ,)}\n")] ||
        !parse_unsigned(row_count, strlen(row_count), most_rows_in_header, &rows))
        return refuse(message, "its shape must be (N, 4): x, y, z, radius, is (%.*s",
                      (int)strcspn(shape, ")") + 1, shape);
    header->rows = rows;
    return STATUS_DONE;
}

/* text: the beginning of the file, of MOST_HEADER bytes or the whole file, and a 0. */
static enum status parse_header(char *text, size_t length, struct header *header, char message[NPY_MESSAGE])
{
    enum { BEFORE = 10 }; /* the dictionary: bytes */
    const unsigned char *bytes = (const unsigned char *)text;
    if (length < BEFORE || memcmp(text, "\x93NUMPY", 6) != 0)
        return refuse(message, "is not a NumPy file (.npy)");
    if (bytes[6] != 1 || bytes[7] != 0)
        return refuse(message, "has version %d.%d of NumPy's format; 1.0 is known", bytes[6], bytes[7]);
    header->size = BEFORE + (size_t)(bytes[8] | bytes[9] << 8);
    if (header->size > MOST_HEADER)
        return refuse(message, "has a header of %zu bytes, more than %d", header->size, MOST_HEADER);
    if (header->size > length)
        return refuse(message, "is truncated: it ends in its header");
    text[header->size] = 0;
    return parse_dictionary(text + BEFORE, header, message);
}

/* Whether the file has as many bytes as its header says. */
static enum status check_size(const struct header *header, size_t size, char message[NPY_MESSAGE])
{
    size_t row_size = NPY_COLUMNS * header->value_size;
    size_t expected = header->size + header->rows * row_size;
    if (size < expected)
        return refuse(message, "is truncated: its header says %zu rows, it ends in row %zu", header->rows,
                      size > header->size ? (size - header->size) / row_size : 0);
    if (size > expected)
        return refuse(message, "is longer than its header says: %zu bytes behind row %zu of %zu",
                      size - expected, header->rows - (header->rows > 0), header->rows);
    return STATUS_DONE;
}

static enum status read_header(struct reading *reading, size_t most_rows)
{
    char text[MOST_HEADER + 1];
    ssize_t got = input_file_read(reading->file, text, MOST_HEADER);
    if (got < 0)
        return refuse_errno(reading->message);
    enum status status = parse_header(text, (size_t)got, &reading->header, reading->message);
    if (status != STATUS_DONE)
        return status;
    const struct header *header = &reading->header;
    if (header->rows > most_rows)
        return refuse(reading->message, "has %zu rows; a scene may have %d spheres in all", header->rows,
                      SCENE_MAX_SPHERES);
    const off_t size = lseek(reading->file, 0, SEEK_END);
    if (size < 0 || lseek(reading->file, (off_t)header->size, SEEK_SET) < 0)
        return refuse_errno(reading->message);
    return check_size(header, (size_t)size, reading->message);
}

enum status npy_read(const char *path, const struct npy_column columns[NPY_COLUMNS], size_t most_rows,
                     float (**rows)[NPY_COLUMNS], size_t *row_count, char message[NPY_MESSAGE])
{
    struct reading reading = {.columns = columns, .message = message};
    reading.file = input_file_open(path, true);
    enum status status = reading.file < 0 ? refuse_errno(message) : STATUS_DONE;
    if (status == STATUS_DONE)
        status = read_header(&reading, most_rows);
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
