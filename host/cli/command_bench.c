#include "cli/options.h"

#include <stdio.h>

#include "base/json.h"
#include "bench/compare.h"
#include "bench/document.h"
#include "bench/report.h"
#include "bench/scene.h"
#include "bench/table.h"

static enum status measure(const struct options *options, struct vulkan_context *context, json_t *document)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < options->scene_count && status == STATUS_DONE; ++i) {
        json_t *scene;
        status = bench_scene(
            &(struct bench_options){
                .width = options->job.width,
                .height = options->job.height,
                .quick = options->quick,
                .quiet = options->job.quiet,
                .wants_pictures = options->report != NULL,
            },
            context, options->scenes[i], &scene);
        if (status != STATUS_DONE)
            break;
        if (i > 0)
            putchar('\n');
        bench_print_scene(scene, stdout);
        fflush(stdout);
        if (json_array_append_new(json_object_get(document, "scenes"), scene) != 0) {
            log_error("no memory for the result of %s", options->scenes[i]);
            status = STATUS_UNABLE;
        }
    }
    return status;
}

static enum status deliver(const struct options *options, json_t *document, const json_t *old)
{
    json_t *scenes = json_object_get(document, "scenes"), *scene;
    enum status status = STATUS_DONE;
    size_t i;
    if (options->report)
        status = report_write(document, options->report);
    json_array_foreach(scenes, i, scene)
    {
        json_object_del(scene, "pictures"); /* for the report alone */
    }
    if (status == STATUS_DONE && options->csv)
        status = bench_csv_write(document, options->csv);
    if (status == STATUS_DONE && options->json)
        status = json_write(json_incref(document), options->json);
    if (status == STATUS_DONE && old) {
        putchar('\n');
        status = bench_compare(old, document, stdout);
    }
    return status;
}

enum status command_bench(const struct options *options)
{
    struct vulkan_context *context = NULL; /* stays so with --backend cpu */
    json_t *old = NULL, *document = NULL;
    enum status status = STATUS_DONE;
    if (options->compare)
        status = bench_document_read(options->compare, &old);
    if (status == STATUS_DONE && options->backend == BACKEND_VULKAN)
        status = vulkan_context_create(&options->vulkan, &context);
    if (status == STATUS_DONE) {
        document = bench_document(options->argc, options->argv, options->quick, context);
        if (!document) {
            log_error("no memory for the results, or the command line is not UTF-8");
            status = STATUS_UNABLE;
        }
    }
    if (status == STATUS_DONE)
        status = measure(options, context, document);
    if (status == STATUS_DONE)
        status = deliver(options, document, old);
    json_decref(document);
    json_decref(old);
    enum status closed = vulkan_context_destroy(&context);
    return status == STATUS_DONE ? closed : status;
}
