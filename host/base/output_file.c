#include "base/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void report(const char *path, const char *what, int error)
{
    log_error("%s: %s: %s", path, what, strerror(error));
}

/* The path of the file to replace, symbolic links resolved, or NULL (reported). *mode gets the
 * permission bits of the file that is there, or -1 where there is none. */
static char *find_target(const char *path, int *mode)
{
    struct stat info;
    const char *problem = NULL;
    *mode = -1;
    const bool exists = lstat(path, &info) == 0, fresh = !exists && errno == ENOENT && path[0] != '\0';
    char *target = fresh ? strdup(path) : realpath(path, NULL);
    if (!target) {
        report(path, exists && S_ISLNK(info.st_mode) ? "cannot follow the symbolic link" : "cannot write",
               errno);
        return NULL;
    }
    if (fresh)
        return target;
    if (stat(target, &info) != 0 ||
        (S_ISREG(info.st_mode) && faccessat(AT_FDCWD, target, W_OK, AT_EACCESS) != 0))
        problem = strerror(errno);
    else if (!S_ISREG(info.st_mode))
        problem = S_ISDIR(info.st_mode) ? strerror(EISDIR) : "not a regular file";
    *mode = (int)(info.st_mode & 0777);
    if (!problem)
        return target;
    log_error("%s: cannot write: %s", path, problem);
    free(target);
    return NULL;
}

/* Creates a file beside target under a name nobody has: exclusive and with mode 0666 it has the permissions
 * (umask, default ACL) of any new file, which mkstemp() does not give. NULL and errno on failure. */
static FILE *create_beside(const char *target, char **temporary)
{
    const char *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
    FILE *stream = NULL;
    errno = EEXIST;
    for (int attempt = 0; !stream && errno == EEXIST && attempt < 100; attempt++) {
        free(*temporary);
        /* 200: names end at 255 bytes. */
        if (asprintf(temporary, "%.*s.%.200s.%ld.%d", (int)(name - target), target, name, (long)getpid(),
                     attempt) < 0) {
            *temporary = NULL;
            errno = ENOMEM;
            break;
        }
        stream = fopen(*temporary, "w+bxe"); /* x: O_EXCL, e: O_CLOEXEC */
    }
    return stream;
}

static void release(struct output_file *file)
{
    free(file->target);
    free(file->temporary);
    *file = (struct output_file){0};
}

enum status output_file_open(const char *path, struct output_file *file)
{
    int mode;
    *file = (struct output_file){.path = path};
    file->target = find_target(path, &mode);
    if (!file->target)
        return STATUS_UNABLE;
    file->stream = create_beside(file->target, &file->temporary);
    if (!file->stream) {
        report(path, "cannot create a file there", errno);
        release(file);
        return STATUS_UNABLE;
    }
    if (mode >= 0) /* not possible everywhere (FAT), and no reason to lose the file */
        (void)fchmod(fileno(file->stream), (mode_t)mode);
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
    int error = file->error;
    errno = EIO; /* where a write failed that nobody noticed */
    if (error == 0 && (ferror(file->stream) || fflush(file->stream) != 0 ||
                       (fsync(fileno(file->stream)) != 0 && errno != EINVAL))) /* a file system without it */
        error = errno;
    if (fclose(file->stream) != 0 && error == 0)
        error = errno;
    const bool written = error == 0;
    if (written && rename(file->temporary, file->target) != 0)
        error = errno;
    if (error != 0) {
        unlink(file->temporary);
        report(file->path, written ? "cannot put the finished file in place" : "cannot write", error);
    }
    release(file);
    return error == 0 ? STATUS_DONE : STATUS_UNABLE;
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
