#ifndef VKWHITTED_WATCH_BACKGROUND_CHECK_H
#define VKWHITTED_WATCH_BACKGROUND_CHECK_H

#include "watch/picture.h"

/* A thread that compares pictures with the reference, when nothing else wants the processor, and says how
 * many pixels differ. */
struct background_check;

/* On failure (reported) *check is NULL. Not talkative: only counts. */
enum status background_check_create(bool talkative, struct background_check **check);

/* Ends the comparison that is going on, too. */
void background_check_destroy(struct background_check **check);

/* Has the picture compared, instead of an older one that is not done. */
void background_check_submit(struct background_check *check, struct picture *picture);

#endif
