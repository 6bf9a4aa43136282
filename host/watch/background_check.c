#include "watch/background_check.h"

#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "check/compare.h"

enum { BAND_HEIGHT = 8 }; /* rows between looks at whether there is something newer */

/* Without locks: the thread may be stopped for long wherever it is, and nobody waits for it. */
struct background_check {
    pthread_t thread;
    sem_t wake;
    _Atomic(struct picture *) next; /* NULL: none */
    atomic_bool stop;
    bool talkative;
};

static bool is_outdated(struct background_check *check)
{
    return atomic_load(&check->stop) || atomic_load(&check->next) || interrupt_requested();
}

/* Adds the differing pixels and the rays of the rows from y on; false if the reference could not be rendered.
 */
static bool compare_band(const struct picture *picture, unsigned y, size_t *differing, uint64_t *rays)
{
    struct render_plan plan = picture->job.plan;
    struct rendering reference;
    struct comparison comparison;
    unsigned left = picture->image.height - y;
    plan.window.y += y;
    plan.window.height = left < BAND_HEIGHT ? left : BAND_HEIGHT;
    plan.quiet = true;
    if (render_on_cpu(&plan, &reference) != STATUS_DONE)
        return false;
    const struct image *image = &picture->image;
    const size_t first = (size_t)y * plan.window.width * 3;
    const struct image band = {.width = plan.window.width,
                               .height = plan.window.height,
                               .rgb = image->rgb + first,
                               .rgb64 = image->rgb64 ? image->rgb64 + first : NULL};
    enum status status = image_compare(&band, &reference.image, NULL, &comparison);
    *differing += comparison.differing;
    *rays += reference.rays.primary + reference.rays.secondary + reference.rays.shadow;
    image_destroy(&reference.image);
    return status == STATUS_DONE || status == STATUS_DIFFERS;
}

static void compare(struct background_check *check, struct picture *picture)
{
    const struct image *image = &picture->image;
    size_t differing = 0;
    uint64_t rays = 0;
    double start = clock_ms();
    for (unsigned y = 0; y < image->height; y += BAND_HEIGHT)
        if (is_outdated(check) || !compare_band(picture, y, &differing, &rays))
            return;
    atomic_store(&picture->rays, rays);
    if (!check->talkative)
        return;
    size_t pixels = (size_t)image->width * image->height;
    double milliseconds = clock_ms() - start;
    if (differing == 0)
        log_notice("picture %u: agrees with the reference in all %zu pixels (after %.0f ms)", picture->number,
                   pixels, milliseconds);
    else
        log_notice("picture %u: %zu of %zu pixels differ from the reference (after %.0f ms)", picture->number,
                   differing, pixels, milliseconds);
}

static void *run(void *argument)
{
    struct background_check *check = argument;
    sched_setscheduler(0, SCHED_IDLE, &(struct sched_param){0}); /* and with it the reference's threads */
    while (!atomic_load(&check->stop)) {
        struct picture *picture = atomic_exchange(&check->next, NULL);
        if (picture)
            compare(check, picture);
        else
            sem_wait(&check->wake);
        picture_release(&picture);
    }
    return NULL;
}

enum status background_check_create(bool talkative, struct background_check **pointer)
{
    struct background_check *check = *pointer = calloc(1, sizeof *check);
    if (!check) {
        log_error("no memory for --check");
        return STATUS_UNABLE;
    }
    check->talkative = talkative;
    sem_init(&check->wake, 0, 0);
    int error = pthread_create(&check->thread, NULL, run, check);
    if (error == 0)
        return STATUS_DONE;
    log_error("--check: cannot start a thread: %s", strerror(error));
    sem_destroy(&check->wake);
    free(check);
    *pointer = NULL;
    return STATUS_UNABLE;
}

void background_check_destroy(struct background_check **pointer)
{
    struct background_check *check = *pointer;
    *pointer = NULL;
    if (!check)
        return;
    atomic_store(&check->stop, true);
    sem_post(&check->wake);
    pthread_join(check->thread, NULL);
    struct picture *next = atomic_load(&check->next);
    picture_release(&next);
    sem_destroy(&check->wake);
    free(check);
}

void background_check_submit(struct background_check *check, struct picture *picture)
{
    struct picture *older = atomic_exchange(&check->next, picture_share(picture));
    picture_release(&older);
    sem_post(&check->wake);
}
