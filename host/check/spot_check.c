#include "check/spot_check.h"

#include <string.h>

#include "tracer/reference_scene.h"

/* Whether the image has the reference's pixel there, given in the window. */
static enum status check_pixel(const struct render_plan *plan, const struct image *image, unsigned x,
                               unsigned y, bool *same)
{
    const struct window strip = window_strip(plan->window, plan->strips, y);
    struct render_plan one = {
        .scene = plan->scene,
        .window = {strip.x + x, strip.y, 1, 1},
        .precision = plan->precision,
        .threads = 1,
        .quiet = true,
    };
    const size_t place = 3 * ((size_t)y * image->width + x);
    struct rendering reference;
    enum status status = render_on_cpu(&one, &reference);
    if (status != STATUS_DONE)
        return status;
    *same =
        memcmp(image->rgb + place, reference.image.rgb, 3 * sizeof *image->rgb) == 0 &&
        (!image->rgb64 || memcmp(image->rgb64 + place, reference.image.rgb64, 3 * sizeof *image->rgb64) == 0);
    image_destroy(&reference.image);
    return STATUS_DONE;
}

enum status spot_check(const struct render_plan *plan, const struct image *image, const char *device)
{
    enum {
        MOST = 16,
        PIXELS_EACH = 1024,
        STEP = 7 /* no divisor in common: each row and column of 16 has one */
    };
    const size_t pixels = (size_t)image->width * image->height;
    const unsigned count = pixels / PIXELS_EACH < MOST ? (unsigned)(pixels / PIXELS_EACH) + 1 : MOST;
    struct packed_scene unused; /* its tree is built with all threads */
    enum status status = reference_scene(plan->scene, plan->threads, &unused);
    for (unsigned i = 0; i < count && status == STATUS_DONE; ++i) {
        const unsigned x = (unsigned)((2 * i + 1) * (uint64_t)image->width / (2 * count));
        const unsigned y = (unsigned)((2 * (i * STEP % count) + 1) * (uint64_t)image->height / (2 * count));
        bool same = false;
        status = check_pixel(plan, image, x, y, &same);
        if (status != STATUS_DONE || same)
            continue;
        log_error("%s: pixel (%u, %u) is not the reference's, although the device's arithmetic seemed exact; "
                  "'vkwhitted check' tells more, --fast renders without a promise",
                  device, plan->window.x + x, window_strip(plan->window, plan->strips, y).y);
        status = STATUS_UNABLE;
    }
    return status;
}
