#include "cli/check_against.h"

#include <stdio.h>
#include <stdlib.h>

#include "check/judge.h"

static enum status report(const struct options *options, const char *scene, const struct judgement *judgement,
                          json_t *results)
{
    const char *precision = precision_name(options->against);
    bool explained = judgement->unexplained <= options->allow;
    printf(
        "%s: against %s: relative error median %.2g, 99 %% %.2g, 99.99 %% %.2g, max %.2g @ (%u, %u); "
        "at most %.2g of the bound; %zu pixels with another signature, %zu near a decision, %zu unexplained",
        scene, precision, judgement->median, judgement->percentile_99, judgement->percentile_99_99,
        judgement->max, judgement->max_x, judgement->max_y, judgement->worst_share,
        judgement->other_signature, judgement->close_decisions, judgement->unexplained);
    if (judgement->unexplained > 0)
        printf(" @ (%u, %u)%s", judgement->unexplained_x, judgement->unexplained_y,
               explained ? "" : "  UNEXPLAINED");
    putchar('\n');
    enum status status = explained ? STATUS_DONE : STATUS_DIFFERS;
    if (!options->json)
        return status;
    json_t *result = json_pack(
        "{s:s, s:s, s:b, s:{s:f, s:f, s:f, s:f}, s:f, s:I, s:I, s:I}", "scene", scene, "against", precision,
        "explained", explained, "relative_error", "median", judgement->median, "percentile_99",
        judgement->percentile_99, "percentile_99_99", judgement->percentile_99_99, "max", judgement->max,
        "largest_share_of_bound", judgement->worst_share, "other_signature_pixels",
        (json_int_t)judgement->other_signature, "close_decision_pixels",
        (json_int_t)judgement->close_decisions, "unexplained_pixels", (json_int_t)judgement->unexplained);
    if (json_array_append_new(results, result) != 0) {
        log_error("no memory for the result of %s, or its name is not UTF-8", scene);
        return STATUS_UNABLE;
    }
    return status;
}

enum status check_against(const struct options *options, struct vulkan_context *context, const char *scene,
                          const struct job *job, json_t *results)
{
    struct rendering rendering = {0};
    uint32_t *signatures = NULL;
    struct reference_explanation *explanations = NULL;
    struct judgement judgement;
    enum status status =
        context ? render_on_device(context, &job->plan, &rendering) : render_on_cpu(&job->plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    status = context ? signatures_on_device(context, &job->plan, &signatures)
                     : signatures_on_cpu(&job->plan, &signatures);
    if (status == STATUS_DONE)
        status = explain_on_cpu(&job->plan, options->against, &explanations);
    if (status == STATUS_DONE) {
        status = judge_picture(&rendering.image, signatures, explanations, &judgement);
        if (status != STATUS_UNABLE)
            status = report(options, scene, &judgement, results);
        if (status != STATUS_UNABLE && options->heatmap) {
            enum status written = judgement_heatmap(&rendering.image, explanations, options->heatmap);
            status = written == STATUS_DONE ? status : written;
        }
    }
    free(explanations);
    free(signatures);
    image_destroy(&rendering.image);
    return status;
}
