#ifndef VKWHITTED_BASE_PROGRESS_H
#define VKWHITTED_BASE_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

/* A bar on standard error, if that is a terminal and the work takes more than half a second; and a notice,
 * wherever it is, if after a second of advances the work looks like taking more than a minute. What comes
 * before the first of them, a shader's compilation perhaps, tells nothing of what is to come. */
struct progress {
    const char *label;
    uint64_t done, done_first, begun, total;
    double start_ms, first_ms; /* of the first advance; 0: there was none */
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
