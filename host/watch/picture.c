#include "watch/picture.h"

#include <stdlib.h>

#include "base/clock.h"
#include "check/compare.h"

static const double band_ms = 10; /* what the window may be late by; four times as much on a busy machine */

void picture_destroy(struct picture *picture)
{
    job_destroy(&picture->job);
    image_destroy(&picture->image);
    free(picture);
}

/* False where the reference cannot be rendered (reported). */
static bool compare_band(struct picture *picture)
{
    const unsigned left = picture->image.height - picture->compared;
    const size_t first = (size_t)picture->compared * picture->image.width * 3;
    struct rendering reference;
    struct render_plan plan = picture->job.plan;
    plan.window.y += picture->compared;
    plan.window.height = picture->band < left ? picture->band : left;
    plan.quiet = true;
    if (render_on_cpu(&plan, &reference) != STATUS_DONE)
        return false;
    const struct image band = {.width = plan.window.width,
                               .height = plan.window.height,
                               .rgb = picture->image.rgb + first,
                               .rgb64 = picture->image.rgb64 ? picture->image.rgb64 + first : NULL};
    const struct comparison comparison = image_compare(&band, &reference.image, NULL);
    image_destroy(&reference.image);
    picture->compared += plan.window.height;
    picture->differing += comparison.differing;
    return true;
}

void picture_compare(struct picture *picture)
{
    const size_t pixels = (size_t)picture->image.width * picture->image.height;
    double start = clock_ms();
    bool good = compare_band(picture);
    double end = clock_ms(), milliseconds = end - picture->since_ms;
    if (end - start < band_ms / 2)
        picture->band *= 2;
    else if (end - start > 4 * band_ms && picture->band > 1)
        picture->band /= 2;
    if (good && picture->compared < picture->image.height)
        return;
    picture->band = 0;
    if (good && picture->differing == 0)
        log_notice("picture %u: agrees with the reference in all %zu pixels (after %.0f ms)", picture->number,
                   pixels, milliseconds);
    else if (good)
        log_notice("picture %u: %zu of %zu pixels differ from the reference (after %.0f ms)", picture->number,
                   picture->differing, pixels, milliseconds);
}
