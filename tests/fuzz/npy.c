#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "fuzz.h"
#include "scene/npy.h"
#include "scene/scene.h"

/* The content of a NumPy file of spheres. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct bounds anything = {.least = -DBL_MAX, .most = DBL_MAX, .rule = "a number"};
    static const struct npy_column columns[NPY_COLUMNS] = {
        {"x", &anything}, {"y", &anything}, {"z", &anything}, {"radius", &anything}};
    char path[64], message[NPY_MESSAGE] = "";
    float(*rows)[NPY_COLUMNS];
    size_t count;
    int file = memfd_create("fuzz.npy", 0);
    if (file < 0 || write(file, data, size) != (ssize_t)size)
        abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    enum status status = npy_read(path, columns, SCENE_MAX_SPHERES, &rows, &count, message);
    close(file);
    if (status == STATUS_DONE ? !rows || count * NPY_COLUMNS * sizeof(float) > size : rows || !message[0])
        abort();
    for (size_t i = 0; i < count; ++i)
        (void)*(volatile float *)&rows[i][NPY_COLUMNS - 1];
    free(rows);
    return 0;
}
