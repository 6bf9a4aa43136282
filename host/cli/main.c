#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/interrupt.h"
#include "cli/command_bench.h"
#include "cli/command_check.h"
#include "cli/command_pixel.h"
#include "cli/command_render.h"
#include "cli/command_watch.h"
#include "cli/options.h"
#include "vulkan/probe.h"

static enum status run(const struct options *options)
{
    switch (options->command) {
    case COMMAND_RENDER:
        return command_render(options);
    case COMMAND_CHECK:
        return command_check(options);
    case COMMAND_BENCH:
        return command_bench(options);
    case COMMAND_PIXEL:
        return command_pixel(options);
    case COMMAND_WATCH:
        return command_watch(options);
    case COMMAND_DEVICES:
        return vulkan_print_devices(&options->vulkan, probe_print);
    case COMMAND_COUNT:
        break;
    }
    abort();
}

int main(int argc, char **argv)
{
    struct options options;
    bool finished;
    signal(SIGXFSZ, SIG_IGN); /* a file-size limit is an error like a full disk */
    interrupt_catch();
    enum status status = options_read(argc, argv, &options, &finished);
    if (status == STATUS_DONE && !finished)
        status = run(&options);
    options_destroy(&options);
    if (status == STATUS_DONE && fflush(stdout) != 0) {
        log_error("cannot write to standard output");
        status = STATUS_UNABLE;
    }
    if (status == STATUS_INTERRUPTED)
        interrupt_die();
    return (int)status;
}
