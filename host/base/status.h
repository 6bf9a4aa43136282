#ifndef VKWHITTED_BASE_STATUS_H
#define VKWHITTED_BASE_STATUS_H

#include <stdbool.h>

/* What a command ends with; the values are the program's exit statuses. */
enum status {
    STATUS_DONE = 0,
    STATUS_DIFFERS = 1, /* a check found a difference */
    STATUS_REFUSED = 2, /* bad usage or bad input */
    STATUS_UNABLE = 3,  /* the machine could not do it: no device, no memory, disk full */
};

/* The higher one: where one thing fails, what can still be done is. */
enum status status_worse(enum status a, enum status b);

/* Messages go to standard error as "vkwhitted: error: ...". The function that meets a failure
 * reports it, once, and returns a status; its callers only pass the status on. */
#define log_error(...) log_message(-1, "error: ", __VA_ARGS__)
#define log_warning(...) log_message(0, "warning: ", __VA_ARGS__)
#define log_notice(...) log_message(0, "", __VA_ARGS__)
#define log_info(...) log_message(1, "", __VA_ARGS__)
__attribute__((format(printf, 3, 4))) void log_message(int least_verbosity, const char *severity,
                                                       const char *format, ...);

/* Prints a line of another form, like "path:line:column: error: ...", to standard error. */
__attribute__((format(printf, 1, 2))) void report_line(const char *format, ...);

/* -1: errors only (-q); 0: errors, warnings and notices; 1: all (-v). */
void log_set_verbosity(int verbosity);

#endif
