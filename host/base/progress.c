#include "base/progress.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/escape.h"

enum { BAR_WIDTH = 40 };

/* Not by stdio, which escapes control characters (escape.h). */
static const char wipe[] = "\r\033[K";
static const char *const wipe_behind = "\033[K";

static atomic_bool visible;

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
    char label[128] = "", shown[ESCAPED_SIZE];
    const char *at = progress->label, *end = at + strlen(at);
    while (at < end && strlen(label) + ESCAPED_SIZE < sizeof label) {
        at += escape_character(at, (size_t)(end - at), shown);
        strcat(label, shown);
    }
    dprintf(STDERR_FILENO, "\r%s [%.*s%*s] %3.0f %%  %.0f s left %s", label, filled,
            "########################################", BAR_WIDTH - filled, "", fraction * 100,
            elapsed_ms / 1000 * (1 - fraction) / fraction, wipe_behind);
    visible = true;
}

void progress_wipe(void)
{
    if (atomic_exchange(&visible, false) && write(STDERR_FILENO, wipe, sizeof wipe - 1) < 0)
        visible = true;
}

void progress_end(struct progress *progress)
{
    progress->enabled = false;
    progress_wipe();
}
