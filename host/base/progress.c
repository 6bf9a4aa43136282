#include "base/progress.h"

#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

#include "base/clock.h"

enum { BAR_WIDTH = 40 };

static atomic_bool visible;
static bool allowed = true;

void progress_allow(bool any)
{
    allowed = any;
}

void progress_start(struct progress *progress, const char *label, uint64_t total, bool quiet)
{
    *progress = (struct progress){
        .label = label,
        .total = total,
        .start_ms = clock_ms(),
        .enabled = !quiet && allowed && isatty(STDERR_FILENO),
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
    visible = true;
}

void progress_wipe(void)
{
    if (atomic_exchange(&visible, false))
        fputs("\r\033[K", stderr);
}

void progress_end(struct progress *progress)
{
    progress->enabled = false;
    progress_wipe();
}
