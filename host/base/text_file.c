#include "base/text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/output_file.h"

int input_file_open(const char *path, bool regular_only)
{
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file < 0)
        return -1;
    int error = fstat(file, &about) != 0                  ? errno
                : S_ISDIR(about.st_mode)                  ? EISDIR
                : regular_only && !S_ISREG(about.st_mode) ? EINVAL
                : output_file_claimed(&about)             ? EBUSY
                                                          : 0;
    if (error == 0)
        return file;
    close(file);
    errno = error;
    return -1;
}

ssize_t input_file_read(int file, void *bytes, size_t size)
{
    struct pollfd wanted = {.fd = file, .events = POLLIN};
    size_t got = 0;
    while (got < size) {
        ssize_t part = poll(&wanted, 1, -1) < 0 ? -1 : read(file, (char *)bytes + got, size - got);
        if (part < 0 && errno != EINTR && errno != EAGAIN)
            return -1;
        if (part == 0)
            break;
        got += part > 0 ? (size_t)part : 0;
    }
    return (ssize_t)got;
}

/* Reads to the end of the file, whatever its size was. NULL and errno on failure. */
static char *read_open_file(int file, size_t most, size_t *length)
{
    char *text = NULL;
    size_t size = 0;
    for (size_t room = 4096; size <= most; room *= 2) {
        char *larger = realloc(text, room + 1);
        const ssize_t got = larger ? input_file_read(file, larger + size, room - size) : -1;
        text = larger ? larger : text;
        if (got < 0) {
            free(text); /* which leaves errno alone */
            return NULL;
        }
        size += (size_t)got;
        if (size < room && size <= most) { /* the end */
            text[size] = 0;
            *length = size;
            return text;
        }
    }
    free(text);
    errno = EFBIG;
    return NULL;
}

char *text_file_read(const char *path, bool regular_only, size_t most, size_t *length)
{
    int file = input_file_open(path, regular_only);
    if (file < 0)
        return NULL;
    char *text = read_open_file(file, most, length);
    int error = errno;
    close(file);
    errno = error;
    return text;
}

const char *input_file_problem(int error)
{
    switch (error) {
    case EISDIR:
        return "is a folder, not a file";
    case EINVAL:
        return "is not a regular file";
    case EBUSY:
        return "is also to be written";
    default:
        return strerror(error);
    }
}

enum status input_file_status(int error)
{
    static const int of_the_user[] = {ENOENT, ENOTDIR, EACCES, EPERM, ELOOP, ENAMETOOLONG,
                                      EISDIR, EINVAL,  EBUSY,  EFBIG, ENXIO, ENODEV};
    for (size_t i = 0; i < sizeof of_the_user / sizeof *of_the_user; ++i)
        if (error == of_the_user[i])
            return STATUS_REFUSED;
    return STATUS_UNABLE;
}

enum status input_file_refuse(const char *path)
{
    const int error = errno;
    log_error("%s: cannot read: %s", path, input_file_problem(error));
    return input_file_status(error);
}
