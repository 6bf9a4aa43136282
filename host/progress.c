#include "progress.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 40 };

static volatile sig_atomic_t caught_signal;

double clock_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

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
    int filled = (int)(fraction * BAR_WIDTH);
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

static void catch_signal(int number)
{
    caught_signal = number;
}

void interrupt_catch(void)
{
    const struct sigaction action = {.sa_handler = catch_signal,
                                     .sa_flags = (int)(SA_RESTART | SA_RESETHAND)};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool interrupt_requested(void)
{
    return caught_signal != 0;
}

_Noreturn void interrupt_die(void)
{
    int number = caught_signal ? (int)caught_signal : SIGINT;
    signal(number, SIG_DFL);
    raise(number);
    abort();
}
