#include "base/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

static enum status report(const char *path, const char *what, int error)
{
    log_error("%s: %s: %s", path, what, strerror(error));
    return STATUS_UNABLE;
}

/* The path of the file to replace, symbolic links resolved, or NULL (reported). *mode gets the
 * permission bits of the file that is there, or -1 where there is none. */
static char *find_target(const char *path, int *mode)
{
    struct stat info;
    *mode = -1;
    if (lstat(path, &info) != 0) {
        if (errno != ENOENT) {
            report(path, "cannot write", errno);
            return NULL;
        }
        char *copy = strdup(path);
        if (!copy)
            report(path, "cannot write", errno);
        return copy;
    }
    if (stat(path, &info) != 0) {
        report(path, "cannot follow the symbolic link", errno);
        return NULL;
    }
    if (!S_ISREG(info.st_mode)) {
        log_error("%s: cannot write: %s", path,
                  S_ISDIR(info.st_mode) ? strerror(EISDIR) : "not a regular file");
        return NULL;
    }
    *mode = (int)(info.st_mode & 0777);
    bool writable = faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) == 0;
    char *target = writable ? realpath(path, NULL) : NULL;
    if (!target)
        report(path, "cannot write", errno);
    return target;
}

/* Creates a file beside target under a name nobody has: O_EXCL and mode 0666 give it the permissions
 * (umask, default ACL) of any new file, which mkstemp() does not. -1 and errno on failure. */
static int create_beside(const char *target, char **temporary)
{
    const char *slash = strrchr(target, '/');
    const char *name = slash ? slash + 1 : target;
    int folder_length = (int)(name - target);

    for (int attempt = 0; attempt < 100; attempt++) {
        uint32_t suffix;
        if (getrandom(&suffix, sizeof suffix, 0) != (ssize_t)sizeof suffix)
            return -1;
        /* 200: names end at 255 bytes. */
        if (asprintf(temporary, "%.*s.%.200s.%08" PRIx32, folder_length, target, name, suffix) < 0) {
            *temporary = NULL;
            errno = ENOMEM;
            return -1;
        }
        int fd = open(*temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0)
            return fd;
        int error = errno;
        free(*temporary);
        *temporary = NULL;
        errno = error;
        if (error != EEXIST)
            return -1;
    }
    return -1;
}

static void release(struct output_file *file)
{
    free(file->target);
    free(file->temporary);
    *file = (struct output_file){0};
}

enum status output_file_open(const char *path, struct output_file *file)
{
    *file = (struct output_file){.path = path};
    if (path[0] == '\0')
        return report(path, "cannot write", ENOENT);

    int mode;
    file->target = find_target(path, &mode);
    if (!file->target)
        return STATUS_UNABLE;

    int fd = create_beside(file->target, &file->temporary);
    if (fd < 0) {
        enum status status = report(path, "cannot create a file there", errno);
        release(file);
        return status;
    }
    if (mode >= 0)
        (void)fchmod(fd, (mode_t)mode); /* not everywhere possible (FAT), and no reason to lose the file */
    file->stream = fdopen(fd, "w+b");
    if (!file->stream) {
        enum status status = report(path, "cannot open", errno);
        close(fd);
        unlink(file->temporary);
        release(file);
        return status;
    }
    return STATUS_DONE;
}

bool output_file_write(struct output_file *file, const void *bytes, size_t size)
{
    if (file->error == 0 && fwrite(bytes, 1, size, file->stream) != size)
        file->error = errno ? errno : EIO;
    return file->error == 0;
}

bool output_file_write_at(struct output_file *file, const void *bytes, size_t size, uint64_t offset)
{
    const char *rest = bytes;
    while (size > 0 && file->error == 0) {
        ssize_t written = pwrite(fileno(file->stream), rest, size, (off_t)offset);
        if (written > 0) {
            rest += written;
            size -= (size_t)written;
            offset += (uint64_t)written;
        } else if (written == 0 || errno != EINTR) {
            file->error = written == 0 ? EIO : errno;
        }
    }
    return file->error == 0;
}

enum status output_file_commit(struct output_file *file)
{
    const char *failed = NULL;
    int error = file->error;
    if (error == 0 && ferror(file->stream))
        error = EIO;
    if (error != 0) {
        failed = "cannot write";
    } else if (fflush(file->stream) != 0 || (fsync(fileno(file->stream)) != 0 && errno != EINVAL)) {
        failed = "cannot write"; /* EINVAL: a file system without fsync */
        error = errno;
    }
    if (fclose(file->stream) != 0 && !failed) {
        failed = "cannot write";
        error = errno;
    }
    if (!failed && rename(file->temporary, file->target) != 0) {
        failed = "cannot put the finished file in place";
        error = errno;
    }

    enum status status = STATUS_DONE;
    if (failed) {
        unlink(file->temporary);
        status = report(file->path, failed, error);
    }
    release(file);
    return status;
}

void output_file_abandon(struct output_file *file)
{
    if (!file->stream)
        return;
    fclose(file->stream);
    unlink(file->temporary);
    release(file);
}

enum status output_file_check(const char *path)
{
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status == STATUS_DONE)
        output_file_abandon(&file);
    return status;
}
