#include "render.h"

#include <stdlib.h>
#include <unistd.h>

const char *precision_name(enum precision precision)
{
    static const char *const names[] = {"float", "double", "quad"};
    return names[precision];
}

static int compare_doubles(const void *a, const void *b)
{
    double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 ? values[count / 2] : (values[count / 2 - 1] + values[count / 2]) / 2;
}

typedef enum status render_once(void *renderer, const struct render_plan *plan, struct image *image,
                                struct progress *progress, double *milliseconds);

/* Renders once cold and plan->repeat times warm. */
static enum status render_repeatedly(render_once *render, void *renderer, const struct render_plan *plan,
                                     struct rendering *rendering)
{
    double *warm_ms = calloc(plan->repeat + 1, sizeof *warm_ms);
    enum status status =
        warm_ms ? image_create(plan->window.width, plan->window.height, &rendering->image) : STATUS_UNABLE;
    struct progress progress;
    uint64_t pixels = (uint64_t)plan->window.width * plan->window.height;
    progress_start(&progress, "rendering", pixels * (plan->repeat + 1), plan->quiet);
    if (status == STATUS_DONE)
        status = render(renderer, plan, &rendering->image, &progress, &rendering->first_dispatch_ms);
    for (unsigned i = 0; i < plan->repeat && status == STATUS_DONE; ++i)
        status = render(renderer, plan, &rendering->image, &progress, &warm_ms[i]);
    progress_end(&progress);
    if (status == STATUS_DONE)
        rendering->dispatch_ms = plan->repeat ? median(warm_ms, plan->repeat) : rendering->first_dispatch_ms;
    else
        image_destroy(&rendering->image);
    free(warm_ms);
    return status;
}

static enum status render_once_on_device(void *renderer, const struct render_plan *plan, struct image *image,
                                         struct progress *progress, double *milliseconds)
{
    return tracer_render(renderer, plan->window, image, progress, milliseconds);
}

/* Adds up the pixels of a picture of ray counts. */
static enum status count_rays(struct vulkan_context *context, const struct render_plan *plan,
                              struct reference_rays *rays)
{
    struct tracer *tracer = NULL;
    struct image counts = {0};
    struct progress progress;
    double unused_ms;
    progress_start(&progress, "counting rays", (uint64_t)plan->window.width * plan->window.height,
                   plan->quiet);
    enum status status = image_create(plan->window.width, plan->window.height, &counts);
    if (status == STATUS_DONE)
        status = tracer_create(context, plan->scene,
                               &(struct tracer_options){.fast = plan->fast, .output = OUTPUT_RAYS}, &tracer);
    if (status == STATUS_DONE)
        status = tracer_render(tracer, plan->window, &counts, &progress, &unused_ms);
    progress_end(&progress);
    for (size_t i = 0; status == STATUS_DONE && i < (size_t)counts.width * counts.height; ++i) {
        rays->primary += (uint64_t)counts.rgb[3 * i];
        rays->secondary += (uint64_t)counts.rgb[3 * i + 1];
        rays->shadow += (uint64_t)counts.rgb[3 * i + 2];
    }
    tracer_destroy(&tracer);
    image_destroy(&counts);
    return status;
}

enum status render_on_device(struct vulkan_context *context, const struct render_plan *plan,
                             struct rendering *rendering)
{
    *rendering = (struct rendering){0};
    double start = clock_ms();
    struct tracer *tracer;
    enum status status =
        tracer_create(context, plan->scene, &(struct tracer_options){.fast = plan->fast}, &tracer);
    if (status != STATUS_DONE)
        return status;
    rendering->setup_ms = clock_ms() - start;
    status = render_repeatedly(render_once_on_device, tracer, plan, rendering);
    tracer_destroy(&tracer);
    if (status == STATUS_DONE && plan->count_rays) {
        status = count_rays(context, plan, &rendering->rays);
        if (status != STATUS_DONE)
            image_destroy(&rendering->image);
    }
    return status;
}

/* Renders in bands of some rows, so that Ctrl-C is heard. */
static enum status render_once_on_cpu(void *renderer, const struct render_plan *plan, struct image *image,
                                      struct progress *progress, double *milliseconds)
{
    struct reference_rays *rays = renderer;
    const struct window *window = &plan->window;
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    int threads = plan->threads ? (int)plan->threads : (int)processors;
    unsigned band_height = 65536 / window->width + (unsigned)threads;
    double *band = calloc((size_t)window->width * band_height * 3, sizeof *band);
    if (!band) {
        log_error("no memory for %u rows of %u pixels", band_height, window->width);
        return STATUS_UNABLE;
    }
    *rays = (struct reference_rays){0};
    *milliseconds = 0;
    for (unsigned y = 0; y < window->height && !interrupt_requested(); y += band_height) {
        unsigned height = window->height - y < band_height ? window->height - y : band_height;
        struct reference_window part = {(int)window->x, (int)(window->y + y), (int)window->width,
                                        (int)height};
        double start = clock_ms();
        switch (plan->precision) {
        case PRECISION_FLOAT:
            reference_render_float(plan->scene, part, threads, band, NULL, rays);
            break;
        case PRECISION_DOUBLE:
            reference_render_double(plan->scene, part, threads, band, NULL, rays);
            break;
        case PRECISION_QUAD:
            reference_render_quad(plan->scene, part, threads, band, NULL, rays);
            break;
        }
        *milliseconds += clock_ms() - start;
        size_t values = (size_t)window->width * height * 3;
        for (size_t i = 0; i < values; ++i)
            image->rgb[(size_t)y * window->width * 3 + i] = (float)band[i];
        progress_advance(progress, (uint64_t)window->width * height);
    }
    free(band);
    return interrupt_requested() ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum status render_on_cpu(const struct render_plan *plan, struct rendering *rendering)
{
    *rendering = (struct rendering){0};
    return render_repeatedly(render_once_on_cpu, &rendering->rays, plan, rendering);
}
