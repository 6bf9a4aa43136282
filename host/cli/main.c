#include <signal.h>

#include "base/interrupt.h"
#include "cli/options.h"

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
    if (options.help)
        help_print(stdout);
    else if (options.version)
        help_print_version();
    else if (status == STATUS_DONE)
        status = commands[options.command].run(&options);
    options_destroy(&options);
    if (status == STATUS_DONE && fflush(stdout) != 0) {
        log_error("cannot write to standard output");
        status = STATUS_UNABLE;
    }
    if (status == STATUS_INTERRUPTED)
        interrupt_die();
    return (int)status;
}
