#include "base/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
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
    const bool exists = lstat(path, &info) == 0;
    char *target = exists || errno != ENOENT ? realpath(path, NULL) : strdup(path);
    if (!target) {
        report(path, exists && S_ISLNK(info.st_mode) ? "cannot follow the symbolic link" : "cannot write",
               errno);
        return NULL;
    }
    if (!exists)
        return target;
    const char *problem = NULL;
    if (stat(target, &info) != 0)
        problem = strerror(errno);
    else if (!S_ISREG(info.st_mode))
        problem = S_ISDIR(info.st_mode) ? strerror(EISDIR) : "not a regular file";
    else if (faccessat(AT_FDCWD, target, W_OK, AT_EACCESS) != 0)
        problem = strerror(errno);
    if (problem) {
        log_error("%s: cannot write: %s", path, problem);
        free(target);
        return NULL;
    }
    *mode = (int)(info.st_mode & 0777);
    return target;
}

/* Creates a file beside target under a name nobody has: O_EXCL and mode 0666 give it the permissions
 * (umask, default ACL) of any new file, which mkstemp() does not. -1 and errno on failure. */
static int create_beside(const char *target, char **temporary)
{
    const char *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
    int fd = -1;
    errno = EEXIST;
    for (int attempt = 0; fd < 0 && errno == EEXIST && attempt < 100; attempt++) {
        free(*temporary);
        /* 200: names end at 255 bytes. */
        if (asprintf(temporary, "%.*s.%.200s.%ld.%d", (int)(name - target), target, name, (long)getpid(),
                     attempt) < 0) {
            *temporary = NULL;
            errno = ENOMEM;
            break;
        }
        fd = open(*temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    return fd;
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
    if (file->error == 0 && fseeko(file->stream, (off_t)offset, SEEK_SET) != 0)
        file->error = errno;
    return output_file_write(file, bytes, size);
}

enum status output_file_commit(struct output_file *file)
{
    const char *failed = "cannot write";
    int error = file->error;
    errno = EIO; /* where a write failed that nobody noticed */
    if (error == 0 && (ferror(file->stream) || fflush(file->stream) != 0 ||
                       (fsync(fileno(file->stream)) != 0 && errno != EINVAL))) /* a file system without it */
        error = errno;
    if (fclose(file->stream) != 0 && error == 0)
        error = errno;
    if (error == 0 && rename(file->temporary, file->target) != 0) {
        failed = "cannot put the finished file in place";
        error = errno;
    }
    enum status status = STATUS_DONE;
    if (error != 0) {
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
