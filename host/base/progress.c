#include "base/progress.h"

#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

#include "base/clock.h"

enum { BAR_WIDTH = 40 };

/* Not by stdio, which escapes control characters (escape.h). */
static const char wipe[] = "\r\033[K";
static const char *const wipe_behind = "\033[K";

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
        .announces = !quiet && allowed,
    };
}

static const char *print_duration(double seconds, char text[static 32])
{
    static const struct {
        const char *unit;
        double seconds;
    } units[] = {{"s", 1}, {"minutes", 60}, {"hours", 3600}, {"days", 86400}};
    int i = 0;
    while (i < 3 && seconds >= 2 * units[i + 1].seconds)
        ++i;
    snprintf(text, 32, "%.0f %s", seconds / units[i].seconds, units[i].unit);
    return text;
}

/* Says once that it will take more than a minute, as soon as that can be known. */
static void announce(struct progress *progress, double elapsed_ms)
{
    const bool guesses = progress->done > progress->done_first;
    const uint64_t amount = guesses ? progress->done - progress->done_first : progress->begun;
    const double share = (double)amount / (double)progress->total;
    const double seconds = share > 0 ? elapsed_ms / share / 1000 : 0;
    if (!progress->announces || elapsed_ms < 1000 || !(guesses || seconds > 60))
        return;
    progress->announces = false;
    char text[32];
    if (seconds <= 60)
        return;
    flockfile(stderr); /* not by status.h, which wipes the bar itself */
    progress_wipe();
    fprintf(stderr, "vkwhitted: %s takes %s %s\n", progress->label, guesses ? "about" : "more than",
            print_duration(seconds, text));
    funlockfile(stderr);
}

void progress_begin(struct progress *progress, uint64_t amount)
{
    progress->begun += amount;
}

void progress_advance(struct progress *progress, uint64_t amount)
{
    progress->done = amount < progress->total - progress->done ? progress->done + amount : progress->total;
    const double now_ms = clock_ms();
    if (progress->first_ms == 0) {
        progress->first_ms = now_ms;
        progress->done_first = progress->done;
    }
    announce(progress, now_ms - progress->first_ms);
    if (!progress->enabled || now_ms - progress->start_ms < 500 || progress->done == 0)
        return;
    char text[32];
    double fraction = (double)progress->done / (double)progress->total;
    double left_ms = (now_ms - progress->start_ms) * (1 - fraction) / fraction;
    int filled = (int)(fraction * (double)BAR_WIDTH);
    dprintf(STDERR_FILENO, "\r%s [%.*s%*s] %3.0f %%  %s left %s", progress->label, filled,
            "########################################", BAR_WIDTH - filled, "", fraction * 100,
            print_duration(left_ms / 1000, text), wipe_behind);
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
