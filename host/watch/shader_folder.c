#include "watch/shader_folder.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/status.h"

/* Beside the program, as far as it is known where that is. */
static void find_installed(char path[PATH_MAX])
{
    char program[PATH_MAX], beside[2 * PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    path[0] = 0;
    if (length <= 0)
        return;
    program[length] = 0;
    *strrchr(program, '/') = 0;
    snprintf(beside, sizeof beside, "%s/" SHADERS_FROM_BIN, program);
    if (!realpath(beside, path))
        path[0] = 0;
}

char *shader_file_path(const char *folder)
{
    char installed[PATH_MAX], *path;
    if (!folder) {
        find_installed(installed);
        folder = installed[0] ? installed : SHADERS_OF_SOURCE;
    }
    if (asprintf(&path, "%s/whitted.comp", folder) >= 0)
        return path;
    log_error("no memory for a path");
    return NULL;
}
