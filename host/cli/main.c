#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/escape.h"
#include "base/interrupt.h"
#include "base/output_file.h"
#include "cli/options.h"

/* Standard streams that are closed would be taken by files that are opened, and written to. What is written
 * to standard output then still fails. */
static void fill_standard_streams(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (fcntl(stream, F_GETFD) < 0 &&
            open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY) < 0)
            abort();
}

static enum status run(int argc, char **argv)
{
    struct options options;
    enum status status = command_line_read(argc, argv, &options);
    if (options.help)
        help_print(stdout);
    else if (options.version)
        help_print_version();
    else if (status == STATUS_DONE)
        status = commands[options.command].run(&options);
    options_destroy(&options);
    return status;
}

int main(int argc, char **argv)
{
    fill_standard_streams();
    escape_streams();
    signal(SIGXFSZ, SIG_IGN); /* a file-size limit is an error like a full disk */
    interrupt_catch();
    enum status status = STATUS_REFUSED;
    if (argc < 2)
        help_print(stderr);
    else
        status = run(argc, argv);
    output_file_release();
    if (!escape_flush_output()) {
        log_error("cannot write to standard output: %s", strerror(errno));
        status = status_worse(status, STATUS_UNABLE);
    }
    return (int)status;
}
