#include "check_truth.h"

#include <stdio.h>
#include <stdlib.h>

#include "truth.h"

static enum status report(const struct options *options, const char *scene, const struct truth *truth,
                          json_t *results)
{
    const char *precision = precision_name(options->against);
    bool explained = truth->unexplained <= options->allow;
    printf(
        "%s: against %s: relative error median %.2g, 99 %% %.2g, 99.99 %% %.2g, max %.2g @ (%u, %u); "
        "at most %.2g of the bound; %zu pixels with another signature, %zu near a decision, %zu unexplained",
        scene, precision, truth->median, truth->percentile_99, truth->percentile_99_99, truth->max,
        truth->max_x, truth->max_y, truth->worst_share, truth->other_signature, truth->close_decisions,
        truth->unexplained);
    if (truth->unexplained > 0)
        printf(" @ (%u, %u)%s", truth->unexplained_x, truth->unexplained_y, explained ? "" : "  UNEXPLAINED");
    putchar('\n');
    enum status status = explained ? STATUS_DONE : STATUS_DIFFERS;
    if (!options->json)
        return status;
    json_t *result =
        json_pack("{s:s, s:s, s:b, s:{s:f, s:f, s:f, s:f}, s:f, s:I, s:I, s:I}", "scene", scene, "against",
                  precision, "explained", explained, "relative_error", "median", truth->median,
                  "percentile_99", truth->percentile_99, "percentile_99_99", truth->percentile_99_99, "max",
                  truth->max, "largest_share_of_bound", truth->worst_share, "other_signature_pixels",
                  (json_int_t)truth->other_signature, "close_decision_pixels",
                  (json_int_t)truth->close_decisions, "unexplained_pixels", (json_int_t)truth->unexplained);
    if (json_array_append_new(results, result) != 0) {
        log_error("no memory for the result of %s, or its name is not UTF-8", scene);
        return STATUS_UNABLE;
    }
    return status;
}

enum status check_truth(const struct options *options, struct vulkan_context *context, const char *scene,
                        const struct job *job, json_t *results)
{
    struct rendering rendering = {0};
    uint32_t *signatures = NULL;
    struct reference_explanation *explanations = NULL;
    struct truth truth;
    enum status status =
        context ? render_on_device(context, &job->plan, &rendering) : render_on_cpu(&job->plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    status = context ? signatures_on_device(context, &job->plan, &signatures)
                     : signatures_on_cpu(&job->plan, &signatures);
    if (status == STATUS_DONE)
        status = explain_on_cpu(&job->plan, options->against, &explanations);
    if (status == STATUS_DONE) {
        status = truth_judge(&rendering.image, signatures, explanations, &truth);
        if (status != STATUS_UNABLE)
            status = report(options, scene, &truth, results);
        if (status != STATUS_UNABLE && options->heatmap) {
            enum status written = truth_heatmap(&rendering.image, explanations, options->heatmap);
            status = written == STATUS_DONE ? status : written;
        }
    }
    free(explanations);
    free(signatures);
    image_destroy(&rendering.image);
    return status;
}
