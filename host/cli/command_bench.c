#include "cli/options.h"

#include <stdio.h>

#include "base/json.h"
#include "bench/bench.h"

/* Measures all scenes into the document. */
static enum status measure(const struct options *options, struct vulkan_context *context, json_t *document)
{
    for (size_t i = 0; i < options->scene_count; ++i) {
        json_t *scene;
        enum status status = bench_scene(&options->job, context, options->quick, options->scenes[i], &scene);
        if (status != STATUS_DONE)
            return status;
        if (i > 0)
            putchar('\n');
        bench_print_scene(scene, stdout);
        if (json_array_append_new(json_object_get(document, "scenes"), scene) != 0) {
            log_error("no memory for the result of %s", options->scenes[i]);
            return STATUS_UNABLE;
        }
    }
    return STATUS_DONE;
}

/* Each of them, also where another one fails. */
static enum status deliver(const struct options *options, json_t *document, const json_t *old)
{
    enum status status = options->report ? report_write(document, options->report) : STATUS_DONE;
    if (options->csv)
        status = status_worse(status, bench_csv_write(document, options->csv));
    if (options->json)
        status = status_worse(status, json_write(json_incref(document), options->json));
    if (old) {
        putchar('\n');
        status = status_worse(status, bench_compare(old, document, stdout));
    }
    return status;
}

enum status command_bench(const struct options *options)
{
    struct vulkan_context *context = NULL; /* stays so with --backend cpu */
    json_t *old = NULL, *document = NULL;
    enum status status = options->compare ? bench_document_read(options->compare, &old) : STATUS_DONE;
    if (status == STATUS_DONE && options->backend == BACKEND_VULKAN)
        status = vulkan_context_create(&options->vulkan, &context);
    if (status == STATUS_DONE)
        status = bench_document(options->argc, options->argv, options->quick, context, &document);
    if (status == STATUS_DONE)
        status = measure(options, context, document);
    if (status == STATUS_DONE)
        status = deliver(options, document, old);
    json_decref(document);
    json_decref(old);
    enum status closed = vulkan_context_destroy(&context);
    return status == STATUS_DONE ? closed : status;
}
