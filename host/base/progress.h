#ifndef VKWHITTED_BASE_PROGRESS_H
#define VKWHITTED_BASE_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

/* A bar on standard error, if that is a terminal and the work takes more than half a second; and a notice,
 * wherever it is, if after a second the work looks like taking more than a minute. */
struct progress {
    const char *label;
    uint64_t done, begun, total;
    double start_ms;
    bool enabled, announces;
};

/* Whether any bar is shown: not with -q. */
void progress_allow(bool any);

/* label, which is shown as it is, must outlive the progress. Quiet, it shows nothing. */
void progress_start(struct progress *progress, const char *label, uint64_t total, bool quiet);

/* So much is under way: what is done after some time is a share of that at most. For work of which none is
 * done for long. */
void progress_begin(struct progress *progress, uint64_t amount);

/* So much more is done, or 0, which shows that time goes by. */
void progress_advance(struct progress *progress, uint64_t amount);

/* Wipes the bar; the next advance shows it again. Messages (status.h) do so before they appear. May
 * be called by a signal's handler. */
void progress_wipe(void);

/* Wipes the bar for good, done or not. */
void progress_end(struct progress *progress);

#endif
