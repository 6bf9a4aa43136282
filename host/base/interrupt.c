#include "base/interrupt.h"

#include <signal.h>
#include <stdlib.h>

static volatile sig_atomic_t caught_signal;

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
