#include "base/text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Reads to the end of the file, whatever its size was. NULL and errno on failure. */
static char *read_open_file(int file, size_t size, size_t most, size_t *length)
{
    char *text = malloc(size + 1);
    *length = 0;
    while (text) {
        ssize_t got = read(file, text + *length, size - *length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0 || *length + (size_t)got > most) {
            int error = got < 0 ? errno : EFBIG;
            free(text);
            errno = error;
            return NULL;
        }
        *length += (size_t)got;
        if (got == 0) {
            text[*length] = 0;
            return text;
        }
        if (*length < size)
            continue;
        size *= 2;
        char *larger = realloc(text, size + 1);
        if (!larger)
            free(text);
        text = larger;
    }
    errno = ENOMEM;
    return NULL;
}

char *file_text_read(const char *path, size_t most, size_t *length)
{
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file < 0)
        return NULL;
    char *text = NULL;
    if (fstat(file, &about) == 0) {
        errno = S_ISDIR(about.st_mode) ? EISDIR : EINVAL;
        if (S_ISREG(about.st_mode))
            text = read_open_file(file, 4096, most, length);
    }
    int error = errno;
    close(file);
    errno = error;
    return text;
}
