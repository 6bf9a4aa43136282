#ifndef VKWHITTED_WATCH_PICTURE_H
#define VKWHITTED_WATCH_PICTURE_H

#include "tracer/job.h"

/* A scene and the picture of it. */
struct picture {
    struct job job;
    struct image image; /* empty before it has been rendered */
    unsigned number;    /* the first is 1; 0: not a good one, or a preview */
    double dispatch_ms;

    unsigned band;     /* rows to be compared with the reference next; 0: no more */
    unsigned compared; /* rows */
    size_t differing;  /* pixels of these */
    double since_ms;   /* when the comparison began */
};

void picture_destroy(struct picture *picture);

/* Compares the next rows with the reference, for about 10 ms if one does not take longer; after the last one
 * says how many pixels differ. */
void picture_compare(struct picture *picture);

#endif
