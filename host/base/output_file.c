#include "base/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/interrupt.h"
#include "base/write.h"

/* The outputs that are to be written: those that exist by device and inode, the others by folder and name. */
struct claim {
    struct claim *next;
    const char *path; /* as given; the caller keeps it alive */
    char *target;
    struct stat identity; /* of the file, or else of its folder */
    bool exists;
};
static struct claim *claims;

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

/* The stream's own functions, so that it is known why a write failed: stdio tells only that one did. */
static ssize_t write_to_file(void *cookie, const char *bytes, size_t size)
{
    struct output_file *file = cookie;
    return write_all(file->descriptor, bytes, size, &file->error) ? (ssize_t)size : 0;
}

static void forget_temporary(struct output_file *file)
{
    if (file->temporary)
        interrupt_leaves(file->temporary);
    free(file->temporary);
    file->temporary = NULL;
}

/* Creates a file beside target under a name nobody has: exclusive and with mode 0666 it has the permissions
 * (umask, default ACL) of any new file, which mkstemp() does not give. False and errno on failure. */
static bool create_beside(struct output_file *file)
{
    const char *target = file->target, *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
    errno = EEXIST;
    for (int attempt = 0; file->descriptor < 0 && errno == EEXIST && attempt < 100; attempt++) {
        forget_temporary(file);
        /* 200: names end at 255 bytes. */
        if (asprintf(&file->temporary, "%.*s.%.200s.%ld.%d", (int)(name - target), target, name,
                     (long)getpid(), attempt) < 0) {
            file->temporary = NULL;
            errno = ENOMEM;
            return false;
        }
        errno = EMFILE;
        if (interrupt_removes(file->temporary))
            file->descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (file->descriptor >= 0)
        file->stream = fopencookie(file, "w", (cookie_io_functions_t){.write = write_to_file});
    return file->stream != NULL;
}

static void release(struct output_file *file)
{
    forget_temporary(file);
    free(file->target);
    *file = (struct output_file){.descriptor = -1};
}

enum status output_file_open(const char *path, struct output_file *file)
{
    int mode;
    *file = (struct output_file){.path = path, .descriptor = -1};
    file->target = find_target(path, &mode);
    if (!file->target)
        return STATUS_UNABLE;
    if (!create_beside(file)) {
        report(path, "cannot create a file there", errno);
        output_file_abandon(file);
        return STATUS_UNABLE;
    }
    if (mode >= 0) /* not possible everywhere (FAT), and no reason to lose the file */
        (void)fchmod(file->descriptor, (mode_t)mode);
    return STATUS_DONE;
}

bool output_file_write_at(struct output_file *file, const void *bytes, size_t size, uint64_t offset)
{
    if (file->error == 0 && lseek(file->descriptor, (off_t)offset, SEEK_SET) < 0)
        file->error = errno;
    return write_all(file->descriptor, bytes, size, &file->error);
}

static struct claim **find_claim(const struct stat *identity, bool exists, const char *name)
{
    struct claim **at = &claims;
    for (; *at; at = &(*at)->next)
        if ((*at)->exists == exists && (*at)->identity.st_dev == identity->st_dev &&
            (*at)->identity.st_ino == identity->st_ino &&
            (exists || strcmp(basename((*at)->target), name) == 0))
            break;
    return at;
}

static void drop_claim(struct claim **at)
{
    struct claim *claim = *at;
    *at = claim->next;
    free(claim->target);
    free(claim);
}

enum status output_file_commit(struct output_file *file)
{
    if (fflush(file->stream) != 0 && file->error == 0)
        file->error = errno ? errno : EIO;
    if (file->error == 0 && fsync(file->descriptor) != 0 && errno != EINVAL) /* a file system without it */
        file->error = errno;
    fclose(file->stream);
    if (close(file->descriptor) != 0 && file->error == 0)
        file->error = errno;
    const bool written = file->error == 0;
    if (written && rename(file->temporary, file->target) != 0)
        file->error = errno;
    const int error = file->error;
    if (error != 0) {
        unlink(file->temporary);
        report(file->path, written ? "cannot put the finished file in place" : "cannot write", error);
    }
    for (struct claim **at = &claims; *at;)
        if (error == 0 && strcmp((*at)->target, file->target) == 0)
            drop_claim(at);
        else
            at = &(*at)->next;
    release(file);
    return error == 0 ? STATUS_DONE : STATUS_UNABLE;
}

void output_file_abandon(struct output_file *file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->temporary && file->descriptor >= 0) {
        close(file->descriptor);
        unlink(file->temporary);
    }
    release(file);
}

/* What stat() tells of the folder of the path. */
static bool stat_folder(const char *path, struct stat *about)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash + 1 - path)) : strdup(".");
    const bool found = folder && stat(folder, about) == 0;
    free(folder);
    return found;
}

enum status output_file_claim(const char *path)
{
    struct output_file file;
    struct claim claim = {.next = claims, .path = path};
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    claim.exists = stat(file.target, &claim.identity) == 0;
    bool known = claim.exists || stat_folder(file.target, &claim.identity);
    struct claim *same = *find_claim(&claim.identity, claim.exists, basename(file.target));
    struct claim *kept = malloc(sizeof *kept);
    claim.target = strdup(file.target);
    output_file_abandon(&file);
    if (known && !same && kept && claim.target) {
        *kept = claim;
        claims = kept;
        return STATUS_DONE;
    }
    if (known && same)
        log_error("%s: is written already, as %s", path, same->path);
    else
        log_error("%s: no memory for its name", path);
    free(kept);
    free(claim.target);
    return known && same ? STATUS_REFUSED : STATUS_UNABLE;
}

const char *output_file_claimed(const struct stat *identity)
{
    const struct claim *claim = *find_claim(identity, true, "");
    return claim ? claim->path : NULL;
}

void output_file_release(void)
{
    while (claims)
        drop_claim(&claims);
}
