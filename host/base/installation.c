#include "base/installation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void installation_find(const char *name, char folder[static PATH_MAX])
{
    char program[PATH_MAX], beside[2 * PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = 0;
    const char *slash = strrchr(program, '/');
    snprintf(beside, sizeof beside, "%.*s/" DATA_FROM_BIN "/%s", slash ? (int)(slash - program) : 0, program,
             name);
    if (!slash || !realpath(beside, folder))
        snprintf(folder, PATH_MAX, SOURCE_FOLDER "/%s", name);
}
