#include "watch/picture.h"

#include <stdlib.h>

#include "base/clock.h"
#include "check/compare.h"

static const double batch_ms = 10; /* what the window may be late by */

void picture_destroy(struct picture *picture)
{
    job_destroy(&picture->job);
    image_destroy(&picture->image);
    free(picture);
}

void picture_compare(struct picture *picture)
{
    picture->batch = 256;
    picture->compared_since_ms = clock_ms();
}

/* The pixels to compare next: whole rows, or what fits of one. */
static struct window next_window(const struct picture *picture)
{
    const struct image *image = &picture->image;
    const size_t rows = picture->batch / image->width;
    struct window next = {.x = (unsigned)(picture->compared % image->width),
                          .y = (unsigned)(picture->compared / image->width),
                          .width = image->width,
                          .height = 1};
    unsigned left = next.x == 0 && rows > 0 ? image->height - next.y : image->width - next.x;
    if (next.x == 0 && rows > 0)
        next.height = rows < left ? (unsigned)rows : left;
    else
        next.width = picture->batch < left ? (unsigned)picture->batch : left;
    return next;
}

/* False where the reference cannot be rendered (reported). */
static bool compare_batch(struct picture *picture)
{
    const struct window next = next_window(picture);
    struct render_plan plan = picture->job.plan;
    plan.window = (struct window){plan.window.x + next.x, plan.window.y + next.y, next.width, next.height};
    plan.quiet = true;
    const size_t first = 3 * picture->compared;
    const struct image image = {.width = next.width,
                                .height = next.height,
                                .rgb = picture->image.rgb + first,
                                .rgb64 = picture->image.rgb64 ? picture->image.rgb64 + first : NULL};
    struct rendering reference;
    struct comparison comparison;
    if (render_on_cpu(&plan, &reference) != STATUS_DONE)
        return false;
    image_compare(&image, &reference.image, NULL, &comparison);
    image_destroy(&reference.image);
    picture->compared += (size_t)next.width * next.height;
    picture->differing += comparison.differing;
    picture->rays += reference.rays.primary + reference.rays.secondary + reference.rays.shadow;
    return true;
}

void picture_compare_more(struct picture *picture, bool talkative)
{
    const size_t pixels = (size_t)picture->image.width * picture->image.height;
    double start = clock_ms();
    if (!compare_batch(picture)) {
        picture->batch = 0;
        picture->rays = 0;
        return;
    }
    double now = clock_ms(), milliseconds = now - picture->compared_since_ms;
    if (now - start < batch_ms / 2)
        picture->batch *= 2;
    else if (now - start > batch_ms)
        picture->batch = (picture->batch + 1) / 2;
    if (picture->compared < pixels)
        return;
    picture->batch = 0;
    if (talkative && picture->differing == 0)
        log_notice("picture %u: agrees with the reference in all %zu pixels (after %.0f ms)", picture->number,
                   pixels, milliseconds);
    else if (talkative)
        log_notice("picture %u: %zu of %zu pixels differ from the reference (after %.0f ms)", picture->number,
                   picture->differing, pixels, milliseconds);
}
