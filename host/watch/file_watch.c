#include "watch/file_watch.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/interrupt.h"

enum { MOST_ENTRIES = 1024, MOST_LINKS = 40 };

/* How long nothing must have happened, in milliseconds. */
static const double settled_after_close = 5, settled_while_open = 200, settled_at_most = 1000;

static const uint32_t events_of_interest = IN_MODIFY | IN_CLOSE_WRITE | IN_ATTRIB | IN_CREATE | IN_DELETE |
                                           IN_MOVED_FROM | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF;

/* A name in a folder. */
struct entry {
    int folder; /* inotify's number */
    char name[NAME_MAX + 1];
};

struct file_watch {
    int inotify; /* -1: there is none */
    bool open;   /* the event that came last leaves a file half written or gone */
    double last_event_ms;
    struct entry *entries, *previous;
    size_t entry_count, previous_count;
};

enum status file_watch_create(struct file_watch **pointer)
{
    struct file_watch *watch = *pointer = calloc(1, sizeof *watch);
    if (watch) {
        watch->entries = calloc(MOST_ENTRIES, sizeof *watch->entries);
        watch->previous = calloc(MOST_ENTRIES, sizeof *watch->previous);
    }
    if (!watch || !watch->entries || !watch->previous) {
        log_error("no memory for watching files");
        if (watch)
            watch->inotify = -1;
        file_watch_destroy(pointer);
        return STATUS_UNABLE;
    }
    watch->inotify = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (watch->inotify < 0)
        log_warning("inotify: %s; files are looked at now and then instead", strerror(errno));
    return STATUS_DONE;
}

void file_watch_destroy(struct file_watch **pointer)
{
    struct file_watch *watch = *pointer;
    *pointer = NULL;
    if (!watch)
        return;
    if (watch->inotify >= 0)
        close(watch->inotify);
    free(watch->entries);
    free(watch->previous);
    free(watch);
}

static bool holds_entry(const struct entry *entries, size_t count, int folder, const char *name)
{
    for (size_t i = 0; i < count; ++i)
        if (entries[i].folder == folder && strcmp(entries[i].name, name) == 0)
            return true;
    return false;
}

static bool holds_folder(const struct entry *entries, size_t count, int folder)
{
    for (size_t i = 0; i < count; ++i)
        if (entries[i].folder == folder)
            return true;
    return false;
}

/* Watches for the name in the folder; false if there is no such folder. */
static bool add_entry(struct file_watch *watch, const char *folder, const char *name)
{
    int number = inotify_add_watch(watch->inotify, folder, events_of_interest | IN_ONLYDIR);
    if (number < 0 && errno == ENOSPC)
        log_warning("inotify: no more watches; see /proc/sys/fs/inotify/max_user_watches");
    if (number < 0)
        return false;
    if (watch->entry_count < MOST_ENTRIES && !holds_entry(watch->entries, watch->entry_count, number, name)) {
        struct entry *entry = &watch->entries[watch->entry_count++];
        entry->folder = number;
        snprintf(entry->name, sizeof entry->name, "%s", name);
    }
    return true;
}

/* Follows the path component by component. Watches each symbolic link on the way where it lies, and the file;
 * or where a folder is missing, for that. */
static void add_path(struct file_watch *watch, const char *path)
{
    char done[PATH_MAX] = "", rest[PATH_MAX], target[PATH_MAX], joined[2 * PATH_MAX];
    int links = 0;
    snprintf(rest, sizeof rest, "%s", path);
    strcpy(done, rest[0] == '/' ? "/" : ".");
    while (rest[0]) {
        char *name = rest + strspn(rest, "/");
        size_t length = strcspn(name, "/");
        bool last = name[length + strspn(name + length, "/")] == 0;
        if (length == 0 || length > NAME_MAX)
            return;
        char component[NAME_MAX + 1];
        snprintf(component, sizeof component, "%.*s", (int)length, name);
        snprintf(joined, sizeof joined, "%s/%s", done, component);
        struct stat about;
        bool exists = lstat(joined, &about) == 0;
        bool is_link = exists && S_ISLNK(about.st_mode);
        if (last || is_link || !exists)
            add_entry(watch, done, component);
        if (!exists || strlen(joined) >= PATH_MAX)
            return;
        if (!is_link) {
            memmove(rest, name + length, strlen(name + length) + 1);
            strcpy(done, joined);
            continue;
        }
        ssize_t size = readlink(joined, target, sizeof target - 1);
        if (size < 0 || ++links > MOST_LINKS)
            return;
        target[size] = 0;
        if (snprintf(joined, sizeof joined, "%s%s", target, name + length) >= PATH_MAX)
            return;
        if (target[0] == '/')
            strcpy(done, "/");
        strcpy(rest, joined);
    }
}

bool file_watch_set(struct file_watch *watch, char *const *paths, size_t count)
{
    struct entry *old = watch->entries;
    watch->entries = watch->previous;
    watch->previous = old;
    watch->previous_count = watch->entry_count;
    watch->entry_count = 0;
    if (watch->inotify < 0)
        return false;
    for (size_t i = 0; i < count; ++i)
        add_path(watch, paths[i]);
    bool added = false;
    for (size_t i = 0; i < watch->entry_count && !added; ++i)
        added = !holds_entry(old, watch->previous_count, watch->entries[i].folder, watch->entries[i].name);
    for (size_t i = 0; i < watch->previous_count; ++i)
        if (!holds_folder(watch->entries, watch->entry_count, old[i].folder))
            inotify_rm_watch(watch->inotify, old[i].folder); /* may be gone already */
    return added;
}

static bool takes_note(struct file_watch *watch, const struct inotify_event *event)
{
    if (event->mask & IN_IGNORED)
        return false;
    bool concerns =
        event->mask & (IN_Q_OVERFLOW | IN_DELETE_SELF | IN_MOVE_SELF) ||
        (event->len > 0 && holds_entry(watch->entries, watch->entry_count, event->wd, event->name));
    if (concerns)
        watch->open =
            event->mask & (IN_MODIFY | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_DELETE_SELF | IN_MOVE_SELF);
    return concerns;
}

/* Reads what has come. Returns whether it concerns a file that is watched. */
static bool read_events(struct file_watch *watch)
{
    _Alignas(struct inotify_event) char buffer[16384];
    bool concerned = false;
    ssize_t size;
    while ((size = read(watch->inotify, buffer, sizeof buffer)) > 0)
        for (char *at = buffer; at < buffer + size;) {
            const struct inotify_event *event = (const struct inotify_event *)(void *)at;
            concerned |= takes_note(watch, event);
            at += sizeof *event + event->len;
        }
    if (concerned)
        watch->last_event_ms = clock_ms();
    return concerned;
}

bool file_watch_wait(struct file_watch *watch, double most_ms)
{
    double end = clock_ms() + most_ms;
    for (;;) {
        double left = end - clock_ms();
        struct pollfd events = {.fd = watch->inotify, .events = POLLIN};
        int ready = poll(&events, 1, left > 0 ? (int)left + 1 : 0);
        if (ready > 0 && read_events(watch))
            return true;
        if (ready < 0 || left <= 0) /* a signal, or time is up */
            return false;
    }
}

void file_watch_settle(struct file_watch *watch)
{
    double end = clock_ms() + settled_at_most;
    while (clock_ms() < end && !interrupt_requested())
        if (!file_watch_wait(watch, watch->open ? settled_while_open : settled_after_close))
            return;
}

double file_watch_last_event_ms(const struct file_watch *watch)
{
    return watch->last_event_ms;
}

int file_watch_descriptor(const struct file_watch *watch)
{
    return watch->inotify;
}
