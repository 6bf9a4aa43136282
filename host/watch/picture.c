#include "watch/picture.h"

#include <stdlib.h>

struct picture *picture_create(void)
{
    struct picture *picture = calloc(1, sizeof *picture);
    if (!picture)
        log_error("no memory for a picture");
    else
        atomic_store(&picture->users, 1);
    return picture;
}

struct picture *picture_share(struct picture *picture)
{
    atomic_fetch_add(&picture->users, 1);
    return picture;
}

void picture_release(struct picture **pointer)
{
    struct picture *picture = *pointer;
    *pointer = NULL;
    if (!picture || atomic_fetch_sub(&picture->users, 1) > 1)
        return;
    job_destroy(&picture->job);
    image_destroy(&picture->image);
    free(picture);
}
