#ifndef VKWHITTED_SCENE_NPY_HEADER_H
#define VKWHITTED_SCENE_NPY_HEADER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum {
    NPY_COLUMNS = 4,
    NPY_MESSAGE = 256,
    NPY_MOST_HEADER = 4096 /* bytes; numpy.save() writes 128 for such an array */
};

/* Writes the message; returns STATUS_REFUSED. */
__attribute__((format(printf, 2, 3))) enum status npy_refuse(char message[NPY_MESSAGE], const char *format,
                                                             ...);

/* What stands before the values of an array of shape (rows, 4). */
struct npy_header {
    size_t size; /* of the header, bytes */
    size_t rows;
    size_t value_size; /* 4: float32, 8: float64 */
    bool big_endian, columns_first;
};

/* text: the beginning of the file, of NPY_MOST_HEADER bytes or the whole file. The number of rows is so small
 * that that of bytes is no more than PTRDIFF_MAX. STATUS_REFUSED with a message where it is no such header.
 */
enum status npy_header_parse(const char *text, size_t length, struct npy_header *header,
                             char message[NPY_MESSAGE]);

#endif
