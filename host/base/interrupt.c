#include "base/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <unistd.h>

#include "base/progress.h"

static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGXCPU};

enum { SIGNALS = sizeof signals / sizeof *signals, MOST_FILES = 16 };

static pthread_t main_thread;
static const char *volatile files[MOST_FILES];
static volatile pid_t child;

/* In the main thread, where it comes between two steps of what it tidies up after. */
static void end_by(int number)
{
    if (!pthread_equal(pthread_self(), main_thread)) {
        pthread_kill(main_thread, number);
        return;
    }
    for (size_t i = 0; i < MOST_FILES; ++i)
        if (files[i])
            unlink(files[i]);
    if (child > 0)
        kill(child, SIGTERM);
    progress_wipe();
    signal(number, SIG_DFL);
    raise(number); /* which waits until this has returned */
}

void interrupt_catch(void)
{
    struct sigaction before, action = {.sa_handler = end_by, .sa_flags = SA_RESTART};
    main_thread = pthread_self();
    for (size_t i = 0; i < SIGNALS; ++i)
        sigaddset(&action.sa_mask, signals[i]);
    for (size_t i = 0; i < SIGNALS; ++i)
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signals[i], &action, NULL);
}

static bool replace(const char *path, const char *other)
{
    for (size_t i = 0; i < MOST_FILES; ++i)
        if (files[i] == path) {
            files[i] = other;
            return true;
        }
    return false;
}

bool interrupt_removes(const char *path)
{
    return replace(NULL, path);
}

void interrupt_leaves(const char *path)
{
    replace(path, NULL);
}

void interrupt_ends(pid_t process)
{
    child = process;
}
