#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene/scene.h"
#include "scene/text.h"

enum { MAX_FILE_SIZE = 16 << 20 }; /* bytes; a thousand objects take a tenth of one MiB */

static enum status refuse(const char *path, const char *problem)
{
    fprintf(stderr, "%s: error: %s\n", path, problem);
    return STATUS_REFUSED;
}

/* Reads up to one byte more than a scene file may have. Returns NULL and sets errno on failure. */
static char *read_all(int file, size_t *length)
{
    size_t size = 1 << 16;
    char *text = malloc(size);
    *length = 0;
    while (text) {
        ssize_t got = read(file, text + *length, size - *length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            int error = errno;
            free(text);
            errno = error;
            return NULL;
        }
        *length += (size_t)got;
        if (got == 0 || *length > MAX_FILE_SIZE)
            return text;
        if (*length < size)
            continue;
        size *= 2;
        char *larger = realloc(text, size);
        if (!larger)
            free(text);
        text = larger;
    }
    errno = ENOMEM;
    return NULL;
}

static enum status read_open_file(const char *path, int file, struct scene *scene)
{
    struct stat about;
    if (fstat(file, &about) != 0)
        return refuse(path, strerror(errno));
    if (S_ISDIR(about.st_mode))
        return refuse(path, "is a directory, not a scene file");

    size_t length;
    char *text = read_all(file, &length);
    if (!text && errno == ENOMEM) {
        log_error("no memory to read the scene file %s", path);
        return STATUS_UNABLE;
    }
    if (!text)
        return refuse(path, strerror(errno));
    enum status status = length > MAX_FILE_SIZE ? refuse(path, "is larger than 16 MiB, not a scene file")
                                                : scene_read_text(path, text, length, scene);
    free(text);
    return status;
}

enum status scene_read(const char *path, struct scene *scene)
{
    *scene = (struct scene){0};
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (file < 0)
        return refuse(path, strerror(errno));
    enum status status = read_open_file(path, file, scene);
    close(file);
    return status;
}

void scene_destroy(struct scene *scene)
{
    for (size_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    for (size_t i = 0; i < scene->object_count; i++)
        free(scene->objects[i].name);
    free(scene->path);
    free(scene->materials);
    free(scene->objects);
    free(scene->lights);
    *scene = (struct scene){0};
}
