#include "cli/options.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/clock.h"
#include "check/float_limit.h"
#include "check/judge.h"
#include "check/junit.h"
#include "check/verdict.h"
#include "tracer/job.h"

/* The command's state: results gets a JSON object for each scene, junit a test case. */
struct check {
    const struct options *options;
    struct vulkan_context *context; /* NULL with --backend cpu and --picture */
    json_t *results;
    struct junit junit;
    char reason[256 + PATH_MAX]; /* why the last scene failed that did */
};

/* The file for the heatmap of a scene with this status; NULL: none. In a folder it has the scene's path
 * without suffix, with - for /. */
static const char *heatmap_path(const struct options *options, const char *scene, enum status status,
                                char path[PATH_MAX])
{
    if (!options_heatmap_folder(options))
        return options->heatmap;
    if (status == STATUS_DONE)
        return NULL;
    scene += strspn(scene, "./");
    const char *suffix = strrchr(scene, '.');
    size_t length = strlen(options->heatmap);
    snprintf(path, PATH_MAX, "%s%.*s.png", options->heatmap,
             (int)(suffix && !strchr(suffix, '/') ? (size_t)(suffix - scene) : strlen(scene)), scene);
    for (char *slash = path + length; (slash = strchr(slash, '/'));)
        *slash = '-';
    return path;
}

/* What comes of a comparison by which so many pixels are not right; `reason` has been written. Takes over its
 * result. */
static enum status conclude(struct check *check, const char *scene, size_t wrong, json_t *result,
                            struct heatmap heatmap)
{
    const struct options *options = check->options;
    enum status status = wrong <= options->allow ? STATUS_DONE : STATUS_DIFFERS;
    char path[PATH_MAX];
    const char *heatmap_file = heatmap_path(options, scene, status, path);
    if (heatmap_file) {
        const size_t length = strlen(check->reason);
        snprintf(check->reason + length, sizeof check->reason - length, "; heatmap: %s", heatmap_file);
        status = status_worse(status, heatmap_write(&heatmap, heatmap_file));
    }
    if (!options->json) {
        json_decref(result);
    } else if (json_array_append_new(check->results, result) != 0) {
        log_error("no memory for the result of %s, or its name is not UTF-8", scene);
        status = STATUS_UNABLE;
    }
    return status;
}

static enum status compare(struct check *check, const char *scene, const struct image *device,
                           const struct image *reference)
{
    const struct options *options = check->options;
    const struct comparison comparison =
        image_compare(device, reference, options->has_tolerance ? &options->tolerance : NULL);
    comparison_print(&comparison, scene, options->allow);
    snprintf(check->reason, sizeof check->reason,
             "%zu pixels differ, the first at (%u, %u), the largest error %.9g at (%u, %u)",
             comparison.differing, comparison.first_x, comparison.first_y, comparison.max_error, comparison.x,
             comparison.y);
    return conclude(check, scene, comparison.differing, comparison_json(&comparison, scene, options->allow),
                    difference_heatmap(&(struct image_pair){device, reference}));
}

/* Compares the device's picture with the reference's in the same precision. */
static enum status check_by_reference(struct check *check, const char *scene, const struct render_plan *plan)
{
    struct rendering device, reference;
    enum status status = render_on_device(check->context, plan, &device);
    if (status != STATUS_DONE)
        return status;
    status = render_on_cpu(plan, &reference);
    if (status == STATUS_DONE) {
        status = compare(check, scene, &device.image, &reference.image);
        image_destroy(&reference.image);
    }
    image_destroy(&device.image);
    return status;
}

static enum status judge(struct check *check, const char *scene, const struct image *image,
                         const uint32_t *signatures, const struct reference_explanation *explanations)
{
    const struct options *options = check->options;
    const char *precision = precision_name(options->against);
    struct judgement judgement;
    enum status status = judge_picture(image, signatures, explanations, &judgement);
    if (status == STATUS_UNABLE)
        return status;
    judgement_print(&judgement, scene, precision, options->allow);
    snprintf(check->reason, sizeof check->reason, "%zu pixels unexplained, the first at (%u, %u)",
             judgement.unexplained, judgement.unexplained_x, judgement.unexplained_y);
    return conclude(check, scene, judgement.unexplained,
                    judgement_json(&judgement, scene, precision, options->allow),
                    judgement_heatmap(&(struct judged_picture){image, explanations}));
}

/* Judges the device's picture, or without a device that of the reference's float build, by the exact picture.
 */
static enum status check_by_exact_picture(struct check *check, const char *scene,
                                          const struct render_plan *plan)
{
    struct rendering rendering;
    uint32_t *signatures = NULL;
    struct reference_explanation *explanations = NULL;
    enum status status =
        check->context ? render_on_device(check->context, plan, &rendering) : render_on_cpu(plan, &rendering);
    if (status != STATUS_DONE)
        return status;
    status = check->context ? signatures_on_device(check->context, plan, &signatures)
                            : signatures_on_cpu(plan, &signatures);
    if (status == STATUS_DONE)
        status = explain_on_cpu(plan, check->options->against, &explanations);
    if (status == STATUS_DONE)
        status = judge(check, scene, &rendering.image, signatures, explanations);
    free(explanations);
    free(signatures);
    image_destroy(&rendering.image);
    return status;
}

/* Where the picture's largest error is, as it is shown by the command that shows why. */
static void print_command(const struct options *options, const char *scene, const struct verdicts *verdicts)
{
    const struct window *crop = &options->job.plan.window;
    log_notice("see 'vkwhitted pixel %s %u %u --against %s', and the options of this picture", scene,
               verdicts->x + crop->x, verdicts->y + crop->y, precision_name(options->against));
}

static enum status report_picture(struct check *check, const char *scene, const struct read_image *picture,
                                  const struct reference_explanation *explanations)
{
    const struct options *options = check->options;
    const char *precision = precision_name(options->against);
    struct verdicts verdicts;
    enum status status = verdicts_find(picture, explanations, &options->tolerance, &verdicts);
    verdicts_print(&verdicts, scene, options->picture, precision, options->allow);
    if (status == STATUS_DIFFERS)
        print_command(options, scene, &verdicts);
    snprintf(check->reason, sizeof check->reason,
             "%zu pixels of %s wrong, the largest error %.3g at (%u, %u)", verdicts_wrong(&verdicts),
             options->picture, verdicts.error, verdicts.x, verdicts.y);
    return conclude(check, scene, verdicts_wrong(&verdicts),
                    verdicts_json(&verdicts, scene, options->picture, precision, options->allow),
                    verdicts_heatmap(&(struct compared_picture){picture, explanations, &options->tolerance}));
}

/* Judges a file's picture by the exact one. */
static enum status check_file(struct check *check, const char *scene, const struct render_plan *plan)
{
    const struct options *options = check->options;
    struct read_image picture;
    struct reference_explanation *explanations = NULL;
    enum status status =
        image_read(options->picture, &(struct image_wanted){plan->window, options->transfer}, &picture);
    if (status != STATUS_DONE)
        return status;
    if (plan->scene->quad_light_count > 0 && !options->has_tolerance)
        log_warning(
            "%s: a quad light is estimated with points of this program's choice; a picture that has others "
            "differs by their noise, see --light-samples and --tolerance",
            scene);
    status = explain_on_cpu(plan, options->against, &explanations);
    if (status == STATUS_DONE)
        status = report_picture(check, scene, &picture, explanations);
    free(explanations);
    read_image_destroy(&picture);
    return status;
}

static enum status check_scene(struct check *check, const char *scene)
{
    struct job job;
    enum status status = job_create(&check->options->job, scene, &job);
    if (status != STATUS_DONE)
        return status;
    if (!check->options->picture)
        status = float_limit_warn(&job);
    if (status == STATUS_DONE && check->options->picture)
        status = check_file(check, scene, &job.plan);
    else if (status == STATUS_DONE && check->options->against == PRECISION_FLOAT)
        status = check_by_reference(check, scene, &job.plan);
    else if (status == STATUS_DONE)
        status = check_by_exact_picture(check, scene, &job.plan);
    job_destroy(&job);
    return status;
}

enum status command_check(const struct options *options)
{
    struct check check = {.options = options};
    enum status status = STATUS_DONE;
    if (options_heatmap_folder(options) && mkdir(options->heatmap, 0777) != 0 && errno != EEXIST) {
        log_error("%s: cannot make the folder: %s", options->heatmap, strerror(errno));
        return STATUS_UNABLE;
    }
    if (options->backend == BACKEND_VULKAN && !options->picture)
        status = vulkan_context_create(&options->vulkan, &check.context);
    if (status != STATUS_DONE)
        return status;
    check.results = json_array();
    junit_create(&check.junit);
    for (size_t i = 0; i < options->scene_count; ++i) {
        const double start = clock_ms();
        const enum status outcome = check_scene(&check, options->scenes[i]);
        junit_add(&check.junit, options->scenes[i], (clock_ms() - start) / 1e3, outcome, check.reason);
        status = status_worse(status, outcome);
    }
    if (options->json && json_array_size(check.results) > 0) {
        const struct vulkan_context *context = check.context;
        json_t *document =
            json_pack("{s:s, s:s, s:O}", "device", context ? context->properties.deviceName : "cpu", "driver",
                      context ? context->driver.driverInfo : "plain-C reference", "scenes", check.results);
        status = status_worse(status, json_write(document, options->json));
    }
    json_decref(check.results);
    status = status_worse(status, junit_write(&check.junit, options->junit));
    return status_worse(status, vulkan_context_destroy(&check.context));
}
