#include "base/write.h"

#include <errno.h>
#include <unistd.h>

bool write_all(int descriptor, const char *bytes, size_t size, int *error)
{
    while (size > 0 && *error == 0) {
        const ssize_t part = write(descriptor, bytes, size);
        if (part < 0 && errno != EINTR)
            *error = errno;
        bytes += part > 0 ? part : 0;
        size -= part > 0 ? (size_t)part : 0;
    }
    return *error == 0;
}
