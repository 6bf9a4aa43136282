#include "tracer/render.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/statistics.h"
#include "scene/truncation.h"

const char *precision_name(enum precision precision)
{
    static const char *const names[] = {"float", "double", "quad"};
    return names[precision];
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
    if (status == STATUS_DONE && plan->precision == PRECISION_DOUBLE)
        status = image_widen(&rendering->image);
    struct progress progress;
    uint64_t pixels = (uint64_t)plan->window.width * plan->window.height;
    progress_start(&progress, "rendering", pixels * (plan->repeat + 1), plan->quiet);
    if (status == STATUS_DONE)
        status = render(renderer, plan, &rendering->image, &progress, &rendering->first_dispatch_ms);
    for (unsigned i = 0; i < plan->repeat && status == STATUS_DONE; ++i)
        status = render(renderer, plan, &rendering->image, &progress, &warm_ms[i]);
    progress_end(&progress);
    if (status == STATUS_DONE) {
        sort_doubles(warm_ms, plan->repeat);
        rendering->dispatch_ms =
            plan->repeat ? sorted_quantile(warm_ms, plan->repeat, 0.5) : rendering->first_dispatch_ms;
    } else {
        image_destroy(&rendering->image);
    }
    free(warm_ms);
    return status;
}

static enum status render_once_on_device(void *renderer, const struct render_plan *plan, struct image *image,
                                         struct progress *progress, double *milliseconds)
{
    return tracer_render(renderer, plan->window, image, progress, milliseconds);
}

/* Renders a picture of another output than radiance. */
static enum status render_output(struct vulkan_context *context, const struct render_plan *plan, int output,
                                 struct image *image)
{
    struct tracer *tracer = NULL;
    struct progress progress;
    double unused_ms;
    static const char *const tasks[] = {
        [OUTPUT_RAYS] = "counting rays",
        [OUTPUT_SIGNATURE] = "path signatures",
        [OUTPUT_TRUNCATION] = "untraced rays",
    };
    progress_start(&progress, tasks[output], (uint64_t)plan->window.width * plan->window.height, plan->quiet);
    enum status status = image_create(plan->window.width, plan->window.height, image);
    if (status == STATUS_DONE)
        status = tracer_create(context, plan->scene,
                               &(struct tracer_options){
                                   .double_precision = plan->precision == PRECISION_DOUBLE,
                                   .fast = plan->fast,
                                   .output = output,
                               },
                               &tracer);
    if (status == STATUS_DONE)
        status = tracer_render(tracer, plan->window, image, &progress, &unused_ms);
    progress_end(&progress);
    tracer_destroy(&tracer);
    if (status != STATUS_DONE)
        image_destroy(image);
    return status;
}

enum status rays_on_device(struct vulkan_context *context, const struct render_plan *plan,
                           struct reference_rays *rays)
{
    struct image counts;
    enum status status = render_output(context, plan, OUTPUT_RAYS, &counts);
    if (status != STATUS_DONE)
        return status;
    for (size_t i = 0; i < (size_t)counts.width * counts.height; ++i) {
        rays->primary += (uint64_t)counts.rgb[3 * i];
        rays->secondary += (uint64_t)counts.rgb[3 * i + 1];
        rays->shadow += (uint64_t)counts.rgb[3 * i + 2];
    }
    image_destroy(&counts);
    return STATUS_DONE;
}

/* Room for a value a pixel; NULL (reported) without memory. */
static void *allocate_pixels(const struct window *window, size_t size)
{
    void *pixels = calloc((size_t)window->width * window->height, size);
    if (!pixels)
        log_error("no memory for %u x %u pixels of %zu bytes", window->width, window->height, size);
    return pixels;
}

enum status signatures_on_device(struct vulkan_context *context, const struct render_plan *plan,
                                 uint32_t **signatures)
{
    *signatures = NULL;
    struct image halves;
    enum status status = render_output(context, plan, OUTPUT_SIGNATURE, &halves);
    if (status != STATUS_DONE)
        return status;
    *signatures = allocate_pixels(&plan->window, sizeof **signatures);
    for (size_t i = 0; *signatures && i < (size_t)halves.width * halves.height; ++i)
        (*signatures)[i] = (uint32_t)halves.rgb[3 * i] | (uint32_t)halves.rgb[3 * i + 1] << 16;
    image_destroy(&halves);
    return *signatures ? STATUS_DONE : STATUS_UNABLE;
}

static enum status bound_truncation(struct vulkan_context *context, const struct render_plan *plan,
                                    struct image *image)
{
    struct image charges;
    enum status status = render_output(context, plan, OUTPUT_TRUNCATION, &charges);
    if (status != STATUS_DONE)
        return status;
    image->truncation = allocate_pixels(&plan->window, sizeof *image->truncation);
    for (size_t i = 0; image->truncation && i < (size_t)charges.width * charges.height; ++i)
        image->truncation[i] = (float)truncation_bound(plan->scene, (double)charges.rgb[3 * i]);
    image_destroy(&charges);
    return image->truncation ? STATUS_DONE : STATUS_UNABLE;
}

enum status render_on_device(struct vulkan_context *context, const struct render_plan *plan,
                             struct rendering *rendering)
{
    *rendering = (struct rendering){0};
    double start = clock_ms();
    struct tracer *tracer;
    enum status status = tracer_create(context, plan->scene,
                                       &(struct tracer_options){
                                           .double_precision = plan->precision == PRECISION_DOUBLE,
                                           .fast = plan->fast,
                                       },
                                       &tracer);
    if (status != STATUS_DONE)
        return status;
    rendering->setup_ms = clock_ms() - start;
    status = render_repeatedly(render_once_on_device, tracer, plan, rendering);
    tracer_destroy(&tracer);
    if (status != STATUS_DONE)
        return status;
    if (plan->count_rays)
        status = rays_on_device(context, plan, &rendering->rays);
    if (status == STATUS_DONE && plan->bound_truncation)
        status = bound_truncation(context, plan, &rendering->image);
    if (status != STATUS_DONE)
        image_destroy(&rendering->image);
    return status;
}

static int thread_count(const struct render_plan *plan)
{
    return plan->threads ? (int)plan->threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
}

static void trace_band(const struct render_plan *plan, struct reference_window band,
                       struct reference_picture *picture)
{
    int threads = thread_count(plan);
    switch (plan->precision) {
    case PRECISION_FLOAT:
        reference_render_float(plan->scene, band, threads, picture);
        break;
    case PRECISION_DOUBLE:
        reference_render_double(plan->scene, band, threads, picture);
        break;
    case PRECISION_QUAD:
        reference_render_quad(plan->scene, band, threads, picture);
        break;
    }
}

static void copy_band(const struct render_plan *plan, struct reference_window band,
                      const struct reference_picture *picture, struct image *image)
{
    size_t first = (size_t)(band.y - (int)plan->window.y) * image->width;
    size_t pixels = (size_t)band.width * (size_t)band.height;
    for (size_t i = 0; i < 3 * pixels; ++i)
        image->rgb[3 * first + i] = (float)picture->rgb[i];
    if (image->rgb64)
        memcpy(image->rgb64 + 3 * first, picture->rgb, 3 * pixels * sizeof *picture->rgb);
    for (size_t i = 0; image->truncation && i < pixels; ++i)
        image->truncation[first + i] = (float)truncation_bound(plan->scene, picture->charges[i]);
}

/* Renders in bands of some rows, so that Ctrl-C is heard. */
static enum status render_once_on_cpu(void *renderer, const struct render_plan *plan, struct image *image,
                                      struct progress *progress, double *milliseconds)
{
    struct reference_rays *rays = renderer;
    const struct window *window = &plan->window;
    unsigned band_height = 65536 / window->width + (unsigned)thread_count(plan);
    size_t band_pixels = (size_t)window->width * band_height;
    double *values = calloc(band_pixels * 4, sizeof *values);
    if (plan->bound_truncation && !image->truncation)
        image->truncation = allocate_pixels(window, sizeof *image->truncation);
    if (!values || (plan->bound_truncation && !image->truncation)) {
        log_error("no memory for %u rows of %u pixels", band_height, window->width);
        free(values);
        return STATUS_UNABLE;
    }
    struct reference_picture picture = {
        .rgb = values,
        .charges = plan->bound_truncation ? values + 3 * band_pixels : NULL,
    };
    *milliseconds = 0;
    for (unsigned y = 0; y < window->height && !interrupt_requested(); y += band_height) {
        unsigned height = window->height - y < band_height ? window->height - y : band_height;
        struct reference_window band = {(int)window->x, (int)(window->y + y), (int)window->width,
                                        (int)height};
        double start = clock_ms();
        trace_band(plan, band, &picture);
        *milliseconds += clock_ms() - start;
        copy_band(plan, band, &picture, image);
        progress_advance(progress, (uint64_t)window->width * height);
    }
    *rays = picture.rays;
    free(values);
    return interrupt_requested() ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum status render_on_cpu(const struct render_plan *plan, struct rendering *rendering)
{
    *rendering = (struct rendering){0};
    return render_repeatedly(render_once_on_cpu, &rendering->rays, plan, rendering);
}

enum status explain_on_cpu(const struct render_plan *plan, enum precision precision,
                           struct reference_explanation **explanations)
{
    const struct window *window = &plan->window;
    int threads = thread_count(plan);
    const unsigned band_height = 4 * (unsigned)threads; /* so that Ctrl-C is heard */
    struct reference_explanation *pixels = *explanations = allocate_pixels(window, sizeof *pixels);
    if (!pixels)
        return STATUS_UNABLE;
    struct progress progress;
    progress_start(&progress, "exact picture", (uint64_t)window->width * window->height, plan->quiet);
    for (unsigned y = 0; y < window->height && !interrupt_requested(); y += band_height) {
        unsigned height = window->height - y < band_height ? window->height - y : band_height;
        struct reference_window band = {(int)window->x, (int)(window->y + y), (int)window->width,
                                        (int)height};
        struct reference_explanation *first = pixels + (size_t)y * window->width;
        if (precision == PRECISION_DOUBLE)
            reference_explain_double(plan->scene, band, threads, first);
        else
            reference_explain_quad(plan->scene, band, threads, first);
        progress_advance(&progress, (uint64_t)window->width * height);
    }
    progress_end(&progress);
    if (!interrupt_requested())
        return STATUS_DONE;
    free(pixels);
    *explanations = NULL;
    return STATUS_INTERRUPTED;
}

enum status signatures_on_cpu(const struct render_plan *plan, uint32_t **signatures)
{
    const struct window *window = &plan->window;
    struct reference_picture picture = {
        .rgb = allocate_pixels(window, 3 * sizeof(double)),
        .signatures = *signatures = allocate_pixels(window, sizeof **signatures),
    };
    bool enough = picture.rgb && picture.signatures;
    if (enough)
        reference_render_float(plan->scene,
                               (struct reference_window){(int)window->x, (int)window->y, (int)window->width,
                                                         (int)window->height},
                               thread_count(plan), &picture);
    free(picture.rgb);
    if (enough)
        return STATUS_DONE;
    free(*signatures);
    *signatures = NULL;
    return STATUS_UNABLE;
}
