#include "base/progress.h"

#include <stdio.h>
#include <unistd.h>

#include "base/clock.h"

enum { BAR_WIDTH = 40 };

void progress_start(struct progress *progress, const char *label, uint64_t total, bool quiet)
{
    *progress = (struct progress){
        .label = label,
        .total = total,
        .start_ms = clock_ms(),
        .enabled = !quiet && isatty(STDERR_FILENO),
    };
}

void progress_advance(struct progress *progress, uint64_t amount)
{
    progress->done = amount < progress->total - progress->done ? progress->done + amount : progress->total;
    double elapsed_ms = clock_ms() - progress->start_ms;
    if (!progress->enabled || elapsed_ms < 500 || progress->done == 0)
        return;
    double fraction = (double)progress->done / (double)progress->total;
    int filled = (int)(fraction * (double)BAR_WIDTH);
    fprintf(stderr, "\r%s [%.*s%*s] %3.0f %%  %.0f s left \033[K", progress->label, filled,
            "########################################", BAR_WIDTH - filled, "", fraction * 100,
            elapsed_ms / 1000 * (1 - fraction) / fraction);
    fflush(stderr);
    progress->visible = true;
}

void progress_end(struct progress *progress)
{
    if (progress->visible)
        fputs("\r\033[K", stderr);
    progress->visible = false;
}
