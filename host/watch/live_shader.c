#include "watch/live_shader.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"

static void drop_tracer(struct live_shader *live)
{
    tracer_destroy(&live->tracer);
    compilation_destroy(&live->code);
    picture_release(&live->traced);
}

void live_shader_destroy(struct live_shader *live)
{
    drop_tracer(live);
    compilation_destroy(&live->compilation);
    *live = (struct live_shader){0};
}

static enum status check_interface(struct compilation *compilation, struct shader_choice choice,
                                   const struct shader_source *source)
{
    char problem[128], *message;
    if (tracer_provides((struct spirv){compilation->words, compilation->size}, choice, problem))
        return STATUS_DONE;
    compilation_destroy(compilation);
    if (asprintf(&message, "%s: error: %s\n", source->files[0], problem) < 0) {
        log_error("no memory for a message");
        return STATUS_UNABLE;
    }
    compilation->messages = message;
    return STATUS_REFUSED;
}

enum status live_shader_compile(struct live_shader *live, const struct picture *picture,
                                const struct shader_source *source, bool changed, double *compile_ms)
{
    const struct shader_choice choice = tracer_shader(live->context, &picture->job.packed, &live->options);
    bool same_choice =
        choice.variant == live->choice.variant && choice.scene_in_storage == live->choice.scene_in_storage;
    *compile_ms = 0;
    if (live->compiled && !changed && same_choice) {
        if (live->compilation.words)
            return STATUS_DONE;
        fputs(live->compilation.messages, stderr);
        return STATUS_REFUSED;
    }
    double start = clock_ms();
    compilation_destroy(&live->compilation);
    enum status status = shader_compile(
        live->compiler, source, whitted_defines(choice.variant, choice.scene_in_storage), &live->compilation);
    if (status == STATUS_DONE)
        status = check_interface(&live->compilation, choice, source);
    *compile_ms = clock_ms() - start;
    live->choice = choice;
    live->compiled = status == STATUS_DONE || status == STATUS_REFUSED;
    if (live->compilation.messages)
        fputs(live->compilation.messages, stderr);
    return status;
}

static bool same_code(const struct compilation *a, const struct compilation *b)
{
    return a->size == b->size && memcmp(a->words, b->words, a->size) == 0;
}

/* On failure the old tracer stays. */
static enum status build_tracer(struct live_shader *live, struct picture *picture)
{
    struct tracer *tracer;
    struct compilation code = {malloc(live->compilation.size), live->compilation.size, NULL};
    struct tracer_options options = live->options;
    if (!code.words) {
        log_error("no memory for a shader of %zu bytes", code.size);
        return STATUS_UNABLE;
    }
    memcpy(code.words, live->compilation.words, code.size);
    options.code = (struct spirv){code.words, code.size};
    enum status status = tracer_create(live->context, &picture->job.packed, &options, &tracer);
    if (status != STATUS_DONE) {
        compilation_destroy(&code);
        return status;
    }
    drop_tracer(live);
    malloc_trim(0); /* a driver's compiler needs much memory for a moment */
    live->tracer = tracer;
    live->code = code;
    live->traced = picture_share(picture);
    return STATUS_DONE;
}

static enum status fit_tracer(struct live_shader *live, struct picture *picture, double *pipeline_ms)
{
    *pipeline_ms = 0;
    if (live->tracer && same_code(&live->compilation, &live->code) &&
        tracer_update(live->tracer, &picture->job.packed)) {
        picture_release(&live->traced);
        live->traced = picture_share(picture);
        return STATUS_DONE;
    }
    double start = clock_ms();
    enum status status = build_tracer(live, picture);
    *pipeline_ms = clock_ms() - start;
    return status;
}

enum status live_shader_render(struct live_shader *live, struct picture *picture, double *pipeline_ms)
{
    const struct render_plan *plan = &picture->job.plan;
    struct progress progress;
    enum status status = fit_tracer(live, picture, pipeline_ms);
    if (status == STATUS_DONE)
        status = image_create(plan->window.width, plan->window.height, &picture->image);
    if (status != STATUS_DONE)
        return status;
    progress_start(&progress, "rendering", (uint64_t)plan->window.width * plan->window.height, plan->quiet);
    status = tracer_render(live->tracer, plan->window, &picture->image, &progress, &picture->dispatch_ms);
    progress_end(&progress);
    return status;
}
