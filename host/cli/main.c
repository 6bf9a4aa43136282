#include <signal.h>
#include <stdio.h>

#include "base/interrupt.h"
#include "cli/command_line.h"
#include "cli/help.h"

static enum status run(const struct options *options)
{
    if (options->help)
        help_print(stdout);
    else if (options->version)
        help_print_version();
    else
        return commands[options->command].run(options);
    return STATUS_DONE;
}

int main(int argc, char **argv)
{
    struct options options;
    signal(SIGXFSZ, SIG_IGN); /* a file-size limit is an error like a full disk */
    interrupt_catch();
    if (argc < 2) {
        help_print(stderr);
        return STATUS_REFUSED;
    }
    enum status status = command_line_read(argc, argv, &options);
    if (status == STATUS_DONE)
        status = run(&options);
    command_line_destroy(&options);
    if (status == STATUS_DONE && fflush(stdout) != 0) {
        log_error("cannot write to standard output");
        status = STATUS_UNABLE;
    }
    if (status == STATUS_INTERRUPTED)
        interrupt_die();
    return (int)status;
}
