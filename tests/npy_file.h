#ifndef VKWHITTED_TEST_NPY_FILE_H
#define VKWHITTED_TEST_NPY_FILE_H

/* NumPy files as numpy.save() writes them, and wrong ones. Include after cmocka.h. */

#include <stdio.h>
#include <string.h>

/* Writes what stands before an array: the header of that dictionary, filled up with spaces to 64 bytes as
 * NumPy does. */
static void npy_write_header(FILE *file, const char *dictionary)
{
    const size_t size = 10 + strlen(dictionary) + 1, padding = (64 - size % 64) % 64;
    fwrite("\x93NUMPY\1", 1, 8, file);
    putc((int)(size - 10 + padding) & 0xFF, file);
    putc((int)(size - 10 + padding) >> 8, file);
    fprintf(file, "%s%*s\n", dictionary, (int)padding, "");
}

/* float32 in this machine's byte order, which is little endian. */
static void npy_write(const char *path, size_t count, float (*rows)[4])
{
    char dictionary[128];
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    snprintf(dictionary, sizeof dictionary, "{'descr': '<f4', 'fortran_order': False, 'shape': (%zu, 4), }",
             count);
    npy_write_header(file, dictionary);
    assert_int_equal(fwrite(rows, sizeof *rows, count, file), count);
    assert_int_equal(fclose(file), 0);
}

#endif
