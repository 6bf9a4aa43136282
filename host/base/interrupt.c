#include "base/interrupt.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

static volatile sig_atomic_t caught_signal, ends_process;

static void catch_signal(int number)
{
    caught_signal = number;
    if (ends_process)
        raise(number); /* its default action again, once this returns */
}

void interrupt_catch(void)
{
    const struct sigaction action = {.sa_handler = catch_signal,
                                     .sa_flags = (int)(SA_RESTART | SA_RESETHAND)};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void interrupt_ends_process(bool at_once)
{
    fflush(stdout);
    ends_process = at_once;
    if (at_once && caught_signal)
        interrupt_die();
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
