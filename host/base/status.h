#ifndef VKWHITTED_BASE_STATUS_H
#define VKWHITTED_BASE_STATUS_H

#include <stdbool.h>

/* What a command ends with; the values are the program's exit statuses. */
enum status {
    STATUS_DONE = 0,
    STATUS_DIFFERS = 1, /* a check found a difference */
    STATUS_REFUSED = 2, /* bad usage or bad input */
    STATUS_UNABLE = 3,  /* the machine could not do it: no device, no memory, disk full */
    STATUS_INTERRUPTED = 130,
};

/* Messages go to standard error as "vkwhitted: error: ...". The function that meets a failure
 * reports it, once, and returns a status; its callers only pass the status on. */
__attribute__((format(printf, 1, 2))) void log_error(const char *format, ...);
__attribute__((format(printf, 1, 2))) void log_warning(const char *format, ...);

/* Shown with -v. */
__attribute__((format(printf, 1, 2))) void log_info(const char *format, ...);

/* Shown unless -q. */
__attribute__((format(printf, 1, 2))) void log_notice(const char *format, ...);

/* -1: errors only (-q); 0: errors, warnings and notices; 1: all (-v). */
void log_set_verbosity(int verbosity);

#endif
