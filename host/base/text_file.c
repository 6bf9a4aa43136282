#include "base/text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/interrupt.h"

/* Waits for a pipe or terminal with poll(), which returns after a signal: read() would wait on. */
static ssize_t read_some(int file, char *bytes, size_t size)
{
    struct pollfd wanted = {.fd = file, .events = POLLIN};
    ssize_t got;
    do
        got = poll(&wanted, 1, -1) < 0 ? -1 : read(file, bytes, size);
    while (got < 0 && (errno == EINTR || errno == EAGAIN) && !interrupt_requested());
    return got;
}

/* Reads to the end of the file, whatever its size was. NULL and errno on failure. */
static char *read_open_file(int file, size_t most, size_t *length)
{
    char *text = NULL;
    size_t room = 0, size = 0;
    ssize_t got = 1;
    while (got > 0) {
        if (size == room) {
            room = room ? 2 * room : 4096;
            char *larger = realloc(text, room + 1);
            if (!larger)
                break;
            text = larger;
        }
        got = read_some(file, text + size, room - size);
        size += got > 0 ? (size_t)got : 0;
        if (size > most) {
            errno = EFBIG;
            break;
        }
    }
    if (got != 0) {
        int error = errno;
        free(text);
        errno = error;
        return NULL;
    }
    text[size] = 0;
    *length = size;
    return text;
}

char *text_file_read(const char *path, bool regular_only, size_t most, size_t *length)
{
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file < 0)
        return NULL;
    char *text = NULL;
    if (fstat(file, &about) == 0) {
        if (S_ISDIR(about.st_mode))
            errno = EISDIR;
        else if (regular_only && !S_ISREG(about.st_mode))
            errno = EINVAL;
        else
            text = read_open_file(file, most, length);
    }
    int error = errno;
    close(file);
    errno = error;
    return text;
}
