#include "cli/options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "cli/help.h"
#include "cli/option_table.h"

/* Splits text at the separator into exactly `count` unsigned numbers up to most. */
static bool parse_list(const char *text, char separator, size_t count, unsigned long most, unsigned *values)
{
    for (size_t i = 0; i < count; ++i) {
        const char *end = i + 1 < count ? strchr(text, separator) : text + strlen(text);
        unsigned long value;
        if (!end || !parse_unsigned(text, (size_t)(end - text), most, &value))
            return false;
        values[i] = (unsigned)value;
        text = end + 1;
    }
    return true;
}

static enum status refuse(int id, const char *argument, const char *expected)
{
    log_error("--%s %s: expected %s", option_name(id), argument, expected);
    return STATUS_REFUSED;
}

static enum status read_number(int id, const char *argument, unsigned least, unsigned most, unsigned *value)
{
    if (parse_list(argument, 0, 1, most, value) && *value >= least)
        return STATUS_DONE;
    log_error("--%s %s: expected a whole number from %u to %u", option_name(id), argument, least, most);
    return STATUS_REFUSED;
}

/* The index of the argument among `names`. */
static enum status read_choice(int id, const char *argument, const char *const *names, size_t count,
                               unsigned *choice)
{
    for (size_t i = 0; i < count; ++i)
        if (strcmp(argument, names[i]) == 0) {
            *choice = (unsigned)i;
            return STATUS_DONE;
        }
    fprintf(stderr, "vkwhitted: error: --%s %s: expected", option_name(id), argument);
    for (size_t i = 0; i < count; ++i)
        fprintf(stderr, "%s %s", i == 0 ? "" : " or", names[i]);
    fputc('\n', stderr);
    return STATUS_REFUSED;
}

static enum status read_size(int id, const char *argument, struct options *options)
{
    unsigned size[2];
    if (!parse_list(argument, 'x', 2, SCENE_MAX_SIZE, size) || size[0] == 0 || size[1] == 0)
        return refuse(id, argument, "WIDTHxHEIGHT, each from 1 to 65536");
    options->job.width = size[0];
    options->job.height = size[1];
    return STATUS_DONE;
}

static enum status read_crop(int id, const char *argument, struct options *options)
{
    unsigned crop[4];
    if (!parse_list(argument, ',', 4, SCENE_MAX_SIZE, crop) || crop[2] == 0 || crop[3] == 0)
        return refuse(id, argument,
                      "X,Y,WIDTH,HEIGHT in pixels from the top left, width and height at least 1");
    options->job.has_crop = true;
    options->job.crop = (struct window){crop[0], crop[1], crop[2], crop[3]};
    return STATUS_DONE;
}

static enum status read_tolerance(int id, const char *argument, struct options *options)
{
    const char *comma = strchr(argument, ',');
    size_t length = comma ? (size_t)(comma - argument) : strlen(argument);
    struct tolerance tolerance = {0, 0};
    if (!parse_double(argument, length, &tolerance.absolute) || tolerance.absolute < 0 ||
        (comma &&
         (!parse_double(comma + 1, strlen(comma + 1), &tolerance.relative) || tolerance.relative < 0)))
        return refuse(id, argument, "ABSOLUTE or ABSOLUTE,RELATIVE, not negative");
    options->has_tolerance = true;
    options->tolerance = tolerance;
    return STATUS_DONE;
}

static enum status read_max_error(int id, const char *argument, struct options *options)
{
    if (!parse_double(argument, strlen(argument), &options->job.max_error) || options->job.max_error < 0)
        return refuse(id, argument, "a radiance, not negative");
    options->job.has_max_error = true;
    return STATUS_DONE;
}

static enum status read_count(int id, const char *argument, unsigned long *count)
{
    if (parse_unsigned(argument, strlen(argument), (unsigned long)SCENE_MAX_SIZE * SCENE_MAX_SIZE, count))
        return STATUS_DONE;
    return refuse(id, argument, "a number of pixels");
}

static enum status read_bounces(int id, const char *argument, int *max_bounces)
{
    unsigned value = 0;
    enum status status = read_number(id, argument, 0, SCENE_MAX_BOUNCES, &value);
    *max_bounces = (int)value;
    return status;
}

static enum status read_text(const char *argument, const char **text)
{
    *text = argument;
    return STATUS_DONE;
}

static enum status read_option(int id, const char *argument, struct options *options)
{
    static const char *const backends[] = {"vulkan", "cpu"};
    static const char *const precisions[] = {"float", "double", "quad"};
    static const char *const transfers[] = {"srgb", "linear"};
    unsigned choice = 0;
    enum status status = STATUS_DONE;
    switch (id) {
    case 'o':
        options->outputs[options->output_count++] = argument;
        break;
    case OPTION_DEVICE:
        options->vulkan.device = argument;
        break;
    case OPTION_BACKEND:
        status = read_choice(id, argument, backends, 2, &choice);
        options->backend = (enum backend)choice;
        break;
    case OPTION_PRECISION:
        status = read_choice(id, argument, precisions, 3, &choice);
        options->job.precision = (enum precision)choice;
        break;
    case OPTION_TRANSFER:
        status = read_choice(id, argument, transfers, 2, &choice);
        options->transfer = (enum transfer)choice;
        break;
    case OPTION_FAST:
        options->job.fast = true;
        break;
    case OPTION_SIZE:
        return read_size(id, argument, options);
    case OPTION_CROP:
        return read_crop(id, argument, options);
    case OPTION_MAX_BOUNCES:
        return read_bounces(id, argument, &options->job.max_bounces);
    case OPTION_SAMPLES:
        return read_number(id, argument, 1, SCENE_MAX_SAMPLES, &options->job.samples);
    case OPTION_LIGHT_SAMPLES:
        return read_number(id, argument, 1, SCENE_MAX_SAMPLES, &options->job.light_samples);
    case OPTION_MAX_ERROR:
        return read_max_error(id, argument, options);
    case OPTION_THREADS:
        return read_number(id, argument, 1, 1024, &options->job.threads);
    case OPTION_REPEAT:
        return read_number(id, argument, 1, 100000, &options->job.repeat);
    case OPTION_TOLERANCE:
        return read_tolerance(id, argument, options);
    case OPTION_AGAINST:
        status = read_choice(id, argument, precisions + 1, 2, &choice);
        options->against = (enum precision)(choice + 1);
        break;
    case OPTION_ALLOW:
        return read_count(id, argument, &options->allow);
    case OPTION_VALIDATE:
        options->vulkan.validate = true;
        break;
    case OPTION_STATS:
        options->job.count_rays = true;
        return read_text(argument, &options->stats);
    case OPTION_HEATMAP:
        return read_text(argument, &options->heatmap);
    case OPTION_JSON:
        return read_text(argument, &options->json);
    case OPTION_CSV:
        return read_text(argument, &options->csv);
    case OPTION_REPORT:
        return read_text(argument, &options->report);
    case OPTION_COMPARE:
        return read_text(argument, &options->compare);
    case OPTION_QUICK:
        options->quick = true;
        break;
    case OPTION_SHADERS:
        options->shaders = argument;
        break;
    case OPTION_CHECK:
        options->check = true;
        break;
    case OPTION_WINDOW:
        options->window = true;
        break;
    case 'q':
        options->job.quiet = true;
        log_set_verbosity(-1);
        break;
    case 'v':
        options->verbose = true;
        log_set_verbosity(1);
        break;
    }
    return status;
}

/* Takes the column and the row from behind the scene. */
static enum status read_place(struct options *options)
{
    unsigned *const numbers[] = {&options->x, &options->y};
    if (options->scene_count != 3) {
        log_error("pixel takes a scene file, a column and a row; see 'vkwhitted --help'");
        return STATUS_REFUSED;
    }
    for (int i = 0; i < 2; ++i)
        if (!parse_list(options->scenes[1 + i], 0, 1, SCENE_MAX_SIZE, numbers[i])) {
            log_error("pixel %s %s: expected the column and the row of a pixel, from 0 at the top left",
                      options->scenes[1], options->scenes[2]);
            return STATUS_REFUSED;
        }
    options->scene_count = 1;
    return STATUS_DONE;
}

static enum status check_consistency(struct options *options)
{
    const char *problem = NULL;
    if (options->command == COMMAND_DEVICES)
        problem = options->scene_count ? "devices takes no scene" : NULL;
    else if (options->scene_count == 0)
        problem = "expected a scene file";
    else if (options->command == COMMAND_RENDER && options->scene_count > 1)
        problem = "render takes one scene file";
    else if (options->command == COMMAND_PIXEL && options->job.precision == PRECISION_QUAD)
        problem = "pixel computes in float or double; see --against";
    else if (options->command == COMMAND_WATCH && options->scene_count > 1)
        problem = "watch takes one scene file";
    else if (options->command == COMMAND_WATCH && options->output_count == 0 && !options->window)
        problem = "watch needs -o FILE where there is no display";
    else if (options->job.precision == PRECISION_QUAD && options->backend == BACKEND_VULKAN)
        problem = "--precision quad needs --backend cpu";
    else if (options->job.precision != PRECISION_FLOAT &&
             (options->job.fast || options->against != PRECISION_FLOAT))
        problem = "--fast and --against go with --precision float";
    else if (options->backend == BACKEND_CPU && options->job.fast)
        problem = "--fast is a device's pipeline; it does not go with --backend cpu";
    else if (options->backend == BACKEND_CPU && (options->vulkan.device || options->vulkan.validate))
        problem = "--device and --validate do not go with --backend cpu";
    else if (options->command == COMMAND_CHECK && options->backend == BACKEND_CPU &&
             options->against == PRECISION_FLOAT)
        problem = "check --backend cpu needs --against double or quad";
    else if (options->against != PRECISION_FLOAT && options->has_tolerance)
        problem = "--tolerance does not go with --against, which derives a bound for every pixel";
    else if (options->against != PRECISION_FLOAT && options->job.has_max_error)
        problem = "--max-error does not go with --against, which judges rounding alone";
    else if (options->heatmap && options->scene_count > 1)
        problem = "--heatmap takes one scene file";
    else if (options->heatmap && image_format_of(options->heatmap) != IMAGE_FORMAT_PNG)
        problem = "--heatmap writes a .png";
    if (!problem)
        return options->command == COMMAND_PIXEL ? read_place(options) : STATUS_DONE;
    log_error("%s; see 'vkwhitted --help'", problem);
    return STATUS_REFUSED;
}

static enum status read_command(const char *name, enum command *command)
{
    static const char *const names[COMMAND_COUNT] = {"render", "check", "watch", "bench", "pixel", "devices"};
    for (int i = 0; i < COMMAND_COUNT; ++i)
        if (strcmp(name, names[i]) == 0) {
            *command = (enum command)i;
            return STATUS_DONE;
        }
    log_error("%s: expected a command: render, check, watch, bench, pixel or devices; see 'vkwhitted --help'",
              name);
    return STATUS_REFUSED;
}

/* What getopt_long() did not take: an option that is not there, or one without its value (or with one too
 * many). */
static enum status refuse_option(char **arguments, bool lacks_value)
{
    const char letter[] = {'-', (char)optopt, '\0'};
    bool is_letter = optopt > 0 && optopt < OPTION_FIRST;
    log_error("%s: %s; see 'vkwhitted --help'", is_letter ? letter : arguments[optind - 1],
              lacks_value ? "expected a value behind it" : "no such option, or not in this form");
    return STATUS_REFUSED;
}

enum status options_read(int argc, char **argv, struct options *options, bool *finished)
{
    *finished = false;
    *options = (struct options){.argc = argc, .argv = argv, .job = {.max_bounces = -1, .samples = 1}};
    options->outputs = calloc((size_t)argc, sizeof *options->outputs);
    if (!options->outputs) {
        log_error("no memory for the command line");
        return STATUS_UNABLE;
    }
    if (argc < 2) {
        help_print(stderr);
        return STATUS_REFUSED;
    }
    *finished = strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0;
    if (*finished)
        return help_print(stdout);
    *finished = strcmp(argv[1], "--version") == 0;
    if (*finished)
        return help_print_version();
    opterr = 0; /* the messages are refuse_option()'s */
    enum status status = read_command(argv[1], &options->command);
    while (status == STATUS_DONE) {
        int id = getopt_long(argc - 1, argv + 1, ":o:qvh", option_table, NULL);
        if (id == -1)
            break;
        if (id == '?' || id == ':')
            return refuse_option(argv + 1, id == ':');
        if (!(option_takers(id) >> options->command & 1)) {
            log_error("%s takes no option %s%s", argv[1], id == 'o' ? "-o" : "--", option_name(id));
            return STATUS_REFUSED;
        }
        *finished = id == OPTION_HELP || id == 'h' || id == OPTION_VERSION;
        if (*finished)
            return id == OPTION_VERSION ? help_print_version() : help_print(stdout);
        status = read_option(id, optarg, options);
    }
    options->scenes = argv + 1 + optind;
    options->scene_count = (size_t)(argc - 1 - optind);
    if (options->command == COMMAND_WATCH && options->output_count == 0)
        options->window = options->window || getenv("DISPLAY") || getenv("WAYLAND_DISPLAY");
    return status == STATUS_DONE ? check_consistency(options) : status;
}

void options_destroy(struct options *options)
{
    free(options->outputs);
    *options = (struct options){0};
}
