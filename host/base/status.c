#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/progress.h"

static int log_verbosity;

void log_message(int least_verbosity, const char *severity, const char *format, ...)
{
    if (log_verbosity < least_verbosity)
        return;
    va_list arguments;
    va_start(arguments, format);
    flockfile(stderr);
    progress_wipe();
    fprintf(stderr, "vkwhitted: %s", severity);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    funlockfile(stderr);
    va_end(arguments);
}

void log_set_verbosity(int verbosity)
{
    log_verbosity = verbosity;
    progress_allow(verbosity >= 0);
}
