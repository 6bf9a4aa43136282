#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "command_bench.h"
#include "command_check.h"
#include "command_pixel.h"
#include "command_render.h"
#include "command_watch.h"
#include "options.h"

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
        return vulkan_print_devices(&options->vulkan);
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
