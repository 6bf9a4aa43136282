#ifndef VKWHITTED_WATCH_LIVE_SHADER_H
#define VKWHITTED_WATCH_LIVE_SHADER_H

#include "watch/picture.h"
#include "watch/shader_compiler.h"

/* A shader that changes while the program runs, and the tracer made of it: built anew only where the SPIR-V
 * is another or the scene needs another pipeline. */
struct live_shader {
    struct vulkan_context *context;
    struct shader_compiler *compiler;
    struct tracer_options options;  /* without code */
    struct shader_choice choice;    /* of the compilation */
    struct compilation compilation; /* of the source that was compiled last; no words: it failed */
    bool compiled;                  /* there is a compilation */
    struct tracer *tracer;
    struct compilation code; /* the tracer's */
    struct picture *traced;  /* whose scene the tracer holds */
};

void live_shader_destroy(struct live_shader *live);

/* Compiles the source as the picture's scene wants it, unless that has been done already and it has not
 * changed. Messages are printed. STATUS_REFUSED where it does not compile. *compile_ms is 0 where nothing was
 * compiled. */
enum status live_shader_compile(struct live_shader *live, const struct picture *picture,
                                const struct shader_source *source, bool changed, double *compile_ms);

/* Gives the picture its image, by what was compiled last. *pipeline_ms is the time that a new pipeline took
 * to build, and 0 where the one there was fits. */
enum status live_shader_render(struct live_shader *live, struct picture *picture, double *pipeline_ms);

#endif
