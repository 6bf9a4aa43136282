#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/progress.h"

static int log_verbosity;

static void print_message(const char *severity, const char *format, va_list arguments)
{
    flockfile(stderr);
    progress_wipe();
    fprintf(stderr, "vkwhitted: %s", severity);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    funlockfile(stderr);
}

#define DEFINE_LOG(name, severity, least_verbosity)                                                          \
    void name(const char *format, ...)                                                                       \
    {                                                                                                        \
        if (log_verbosity < (least_verbosity))                                                               \
            return;                                                                                          \
        va_list arguments;                                                                                   \
        va_start(arguments, format);                                                                         \
        print_message(severity, format, arguments);                                                          \
        va_end(arguments);                                                                                   \
    }

DEFINE_LOG(log_error, "error: ", -1)
DEFINE_LOG(log_warning, "warning: ", 0)
DEFINE_LOG(log_notice, "", 0)
DEFINE_LOG(log_info, "", 1)

void log_set_verbosity(int verbosity)
{
    log_verbosity = verbosity;
}
