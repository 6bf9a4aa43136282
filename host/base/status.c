#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/escape.h"
#include "base/progress.h"

static int log_verbosity;

enum status status_worse(enum status a, enum status b)
{
    return a > b ? a : b;
}

static void print_line(const char *start, const char *severity, const char *format, va_list arguments)
{
    char *text = NULL;
    if (vasprintf(&text, format, arguments) < 0)
        text = NULL;
    flockfile(stderr);
    progress_wipe();
    fprintf(stderr, "%s%s", start, severity);
    escape_line(stderr, text ? text : format); /* without memory at least what kind of message it is */
    funlockfile(stderr);
    free(text);
}

void log_message(int least_verbosity, const char *severity, const char *format, ...)
{
    if (log_verbosity < least_verbosity)
        return;
    va_list arguments;
    va_start(arguments, format);
    print_line("vkwhitted: ", severity, format, arguments);
    va_end(arguments);
}

void report_line(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("", "", format, arguments);
    va_end(arguments);
}

void log_set_verbosity(int verbosity)
{
    log_verbosity = verbosity;
    progress_allow(verbosity >= 0);
}
