#ifndef VKWHITTED_SCENE_NPY_H
#define VKWHITTED_SCENE_NPY_H

#include <stddef.h>

#include "base/status.h"
#include "scene/schema.h"

enum { NPY_COLUMNS = 4, NPY_MESSAGE = 256 };

/* What the numbers of a column are and must be. */
struct npy_column {
    const char *name;
    const struct bounds *bounds;
};

/* Reads the NumPy array of shape (N, 4), N <= most_rows, in the file at path: float32 or float64 of either
 * byte order, rows or columns first, as numpy.save() writes it (format version 1.0; NumPy Enhancement
 * Proposal 1). The values are rounded to float. On STATUS_DONE the caller frees *rows, which may have none;
 * otherwise it is NULL, and message says why without naming the file: STATUS_REFUSED for another file,
 * STATUS_UNABLE where the machine could not read it. */
enum status npy_read(const char *path, const struct npy_column columns[NPY_COLUMNS], size_t most_rows,
                     float (**rows)[NPY_COLUMNS], size_t *row_count, char message[NPY_MESSAGE]);

#endif
