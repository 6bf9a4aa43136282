#ifndef VKWHITTED_WATCH_FILE_WATCH_H
#define VKWHITTED_WATCH_FILE_WATCH_H

#include <stddef.h>

#include "base/status.h"

/* Notices when files change, appear or vanish, by inotify on their folders and on those of the symbolic links
 * that lead there. It tells that something has happened, not what: the content says that. */
struct file_watch;

/* Watches nothing yet. Where there is no inotify (reported) it still serves: file_watch_wait() then only
 * waits. STATUS_UNABLE (reported) without memory. */
enum status file_watch_create(struct file_watch **watch);
void file_watch_destroy(struct file_watch **watch);

/* Watches these files, which need not exist, and no others. Returns whether one is among them that was not
 * watched before: it may have changed unnoticed and should be read again. */
bool file_watch_set(struct file_watch *watch, char *const *paths, size_t count);

/* Waits until something happens to a file that is watched, but no longer than this. */
bool file_watch_wait(struct file_watch *watch, double most_ms);

/* Waits until the writing has come to an end: some milliseconds after a file has been closed or renamed,
 * longer after one has been written to without being closed. At most a second. */
void file_watch_settle(struct file_watch *watch);

/* When the event that has come last was read, by clock_ms(). */
double file_watch_last_event_ms(const struct file_watch *watch);

/* To be polled for input by others who wait; -1: none. */
int file_watch_descriptor(const struct file_watch *watch);

#endif
