#ifndef VKWHITTED_WATCH_PICTURE_H
#define VKWHITTED_WATCH_PICTURE_H

#include <stdatomic.h>

#include "tracer/job.h"

/* A scene and the picture of it, shared between threads that only read it. */
struct picture {
    struct job job;
    struct image image; /* empty before it has been rendered */
    unsigned number;    /* the first is 1; 0 before it has been rendered */
    double dispatch_ms;
    atomic_ullong rays; /* as the reference has counted them; 0: not yet */
    atomic_uint users;
};

/* With one user; NULL (reported) without memory. */
struct picture *picture_create(void);
struct picture *picture_share(struct picture *picture);

/* Sets *picture to NULL; frees the picture with its last user. */
void picture_release(struct picture **picture);

#endif
