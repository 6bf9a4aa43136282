#ifndef VKWHITTED_BASE_PROGRESS_H
#define VKWHITTED_BASE_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

/* A bar on standard error, if that is a terminal and the work takes more than half a second. */
struct progress {
    const char *label;
    uint64_t done, total;
    double start_ms;
    bool enabled;
};

/* Whether any bar is shown: not with -q. */
void progress_allow(bool any);

/* label must outlive the progress. Quiet, it shows nothing. */
void progress_start(struct progress *progress, const char *label, uint64_t total, bool quiet);
void progress_advance(struct progress *progress, uint64_t amount);

/* Wipes the bar; the next advance shows it again. Messages (status.h) do so before they appear. */
void progress_wipe(void);

/* Wipes the bar for good, done or not. */
void progress_end(struct progress *progress);

#endif
