#ifndef VKWHITTED_WATCH_PICTURE_H
#define VKWHITTED_WATCH_PICTURE_H

#include "tracer/job.h"

/* A scene and the picture of it. */
struct picture {
    struct job job;
    struct image image; /* empty before it has been rendered */
    unsigned number;    /* the first is 1; 0: not a good one, or a preview */
    double dispatch_ms;

    /* How far it has been compared with the reference. */
    size_t compared, differing; /* pixels */
    uint64_t rays;              /* of the pixels compared */
    size_t batch;               /* pixels to compare next; 0: no more */
    double compared_since_ms;
};

void picture_destroy(struct picture *picture);

/* Starts the comparison. */
void picture_compare(struct picture *picture);

/* Goes on with it for about 10 ms. Says how many pixels differ after the last one, if talkative. */
void picture_compare_more(struct picture *picture, bool talkative);

#endif
