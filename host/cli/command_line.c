#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/output_file.h"
#include "cli/option_table.h"
#include "cli/scene_name.h"

static enum status read_command(const char *name, struct options *options)
{
    char names[COMMAND_NAMES];
    for (int i = 0; i < COMMAND_COUNT; ++i)
        if (strcmp(name, commands[i].name) == 0) {
            options->command = (enum command_id)i;
            return STATUS_DONE;
        }
    log_error("%s: expected a command: %s; see 'vkwhitted --help'", name, command_names(~0u, names));
    return STATUS_REFUSED;
}

enum { LONG_OPTIONS = 256 }; /* getopt_long() returns a letter, or this plus the index of the option */

/* What getopt_long() did not take: an option that is not there, or one without its value (or with one too
 * many). */
static enum status refuse_option(char **words, bool lacks_value)
{
    const char letter[] = {'-', (char)optopt, '\0'};
    log_error("%s: %s; see 'vkwhitted --help'",
              optopt > 0 && optopt < LONG_OPTIONS ? letter : words[optind - 1],
              lacks_value ? "expected a value behind it" : "no such option, or not in this form");
    return STATUS_REFUSED;
}

static const struct option_entry *find_option(int id)
{
    const struct option_entry *option = option_table;
    if (id >= LONG_OPTIONS)
        return &option_table[id - LONG_OPTIONS];
    while (option->letter[0] != id)
        ++option;
    return option;
}

/* is_word: the value is a word of its own, not behind a "=" or a letter. */
static enum status read_option(const struct option_entry *option, const char *value, bool is_word,
                               struct options *options)
{
    const char *dashes = option->name[0] ? "--" : "-";
    const char *name = option->name[0] ? option->name : option->letter;
    if (!(option->commands >> options->command & 1)) {
        log_error("%s takes no option %s%s", commands[options->command].name, dashes, name);
        return STATUS_REFUSED;
    }
    if (!option->read(option, value, (char *)options + option->offset))
        return STATUS_REFUSED;
    if (is_word && value[0] == '-') {
        log_error("%s%s: expected a value behind it; if %s is meant, write %s%s%s%s", dashes, name, value,
                  dashes, name, option->name[0] ? "=" : "", value);
        return STATUS_REFUSED;
    }
    return STATUS_DONE;
}

/* Reads the options behind the command; the other words are the scenes. */
static enum status read_options(int count, char **words, struct options *options)
{
    struct option names[OPTION_COUNT_MAX + 1] = {0}, *name = names;
    char letters[2 * OPTION_COUNT_MAX + 2] = ":"; /* a missing value is then told by ':' */
    for (int i = 0; option_table[i].help; ++i) {
        const struct option_entry *option = &option_table[i];
        if (option->name[0])
            *name++ = (struct option){option->name, option->value ? required_argument : no_argument, NULL,
                                      LONG_OPTIONS + i};
        strcat(strcat(letters, option->letter), option->letter[0] && option->value ? ":" : "");
    }
    opterr = 0; /* the messages are refuse_option()'s */
    enum status status = STATUS_DONE;
    while (status == STATUS_DONE && !options->help && !options->version) {
        int id = getopt_long(count, words, letters, names, NULL);
        if (id == -1)
            break;
        if (id == '?' || id == ':')
            return refuse_option(words, id == ':');
        status = read_option(find_option(id), optarg, optarg && optarg == words[optind - 1], options);
    }
    options->scenes = words + optind;
    options->scene_count = (size_t)(count - optind);
    return status;
}

/* Takes the column and the row from behind the scene. */
static enum status read_place(struct options *options)
{
    char **words = options->scenes;
    options->scene_count = 1;
    if (parse_list(words[1], 0, 1, SCENE_MAX_SIZE, &options->x) &&
        parse_list(words[2], 0, 1, SCENE_MAX_SIZE, &options->y))
        return STATUS_DONE;
    log_error("pixel %s %s: expected the column and the row of a pixel, from 0 at the top left", words[1],
              words[2]);
    return STATUS_REFUSED;
}

bool options_heatmap_folder(const struct options *options)
{
    const size_t length = options->heatmap ? strlen(options->heatmap) : 0;
    return length > 0 && options->heatmap[length - 1] == '/';
}

size_t options_exr_outputs(const struct options *options)
{
    size_t count = 0;
    for (size_t i = 0; i < options->output_count; ++i)
        count += image_format_of(options->outputs[i]) == IMAGE_FORMAT_EXR;
    return count;
}

static enum status check_consistency(const struct options *options)
{
    enum command_id command = options->command;
    enum precision precision = options->job.plan.precision;
    size_t scenes = options->scene_count;
    const char *suffix = options->heatmap ? strrchr(options->heatmap, '.') : NULL;
    bool heatmap_file = options->heatmap && !options_heatmap_folder(options);
    bool cpu = options->backend == BACKEND_CPU, against = options->against != PRECISION_FLOAT;
    const struct {
        bool is_so;
        const char *problem;
    } rules[] = {
        {command == COMMAND_DEVICES && scenes > 0, "devices takes no scene"},
        {command == COMMAND_JOIN && scenes == 0, "join takes the files of a picture's tiles"},
        {command == COMMAND_JOIN && options->output_count == 0, "join needs -o FILE"},
        {command == COMMAND_RENDER && scenes > 1, "render takes one scene file"},
        {command == COMMAND_WATCH && scenes > 1, "watch takes one scene file"},
        {command == COMMAND_WATCH && options->output_count == 0 && !options->window,
         "watch needs -o FILE where there is no display"},
        {command == COMMAND_PIXEL && precision == PRECISION_QUAD,
         "pixel computes in float or double; see --against"},
        {command == COMMAND_PIXEL && scenes != 3, "pixel takes a scene file, a column and a row"},
        {command == COMMAND_CHECK && options->transfer != TRANSFER_SRGB && !options->picture,
         "--transfer is for the .png of --picture"},
        {options->picture && scenes > 1, "--picture takes one scene file"},
        {options->picture &&
             (cpu || options->vulkan.device || options->vulkan.validate || options->job.plan.fast ||
              precision != PRECISION_FLOAT || options->job.has_max_error || options->shaders.path),
         "--picture goes with no device, backend or precision: the exact picture is computed on the CPU"},
        {precision == PRECISION_QUAD && !cpu, "--precision quad needs --backend cpu"},
        {precision != PRECISION_FLOAT && (options->job.plan.fast || against),
         "--fast and --against go with --precision float"},
        {cpu && options->job.plan.fast, "--fast is a device's pipeline; it does not go with --backend cpu"},
        {cpu && (options->vulkan.device || options->vulkan.validate || options->shaders.path),
         "--device, --shaders and --validate do not go with --backend cpu"},
        {cpu && command == COMMAND_CHECK && !against, "check --backend cpu needs --against double or quad"},
        {against && options->has_tolerance && !options->picture,
         "--tolerance does not go with --against, which derives a bound for every pixel"},
        {against && options->job.has_max_error,
         "--max-error does not go with --against, which judges rounding alone"},
        {heatmap_file && scenes > 1,
         "--heatmap FILE.png takes one scene file; for several name a folder, DIR/"},
        {heatmap_file && !(suffix && strcasecmp(suffix, ".png") == 0),
         "--heatmap takes FILE.png or a folder, DIR/"},
        {options->job.tile.count > 0 && options_exr_outputs(options) < options->output_count,
         "--tile writes .exr"},
    };
    for (size_t i = 0; i < sizeof rules / sizeof *rules; ++i)
        if (rules[i].is_so) {
            log_error("%s; see 'vkwhitted --help'", rules[i].problem);
            return STATUS_REFUSED;
        }
    return STATUS_DONE;
}

/* Says that this was given, or where it is NULL nothing, in the place of a scene. */
static enum status refuse_scene(const char *name)
{
    char *list = scene_name_list();
    log_error("%s%sexpected %s", name ? name : "", name ? ": no such scene; " : "",
              list ? list : "a scene file");
    free(list);
    return STATUS_REFUSED;
}

/* Puts the paths of the program's scenes in the place of their names. What is neither a path nor such a name
 * is refused. */
static enum status find_scenes(struct options *options)
{
    char **found = options->found;
    if (options->command == COMMAND_DEVICES || options->command == COMMAND_JOIN)
        return STATUS_DONE;
    if (options->scene_count == 0)
        return refuse_scene(NULL);
    for (size_t i = 0; i < options->scene_count; ++i) {
        char **scene = &options->scenes[i];
        *found = scene_name_find(*scene);
        if (*found)
            *scene = *found++;
        else if (!strpbrk(*scene, "/.") && access(*scene, F_OK) != 0)
            return refuse_scene(*scene);
    }
    return STATUS_DONE;
}

/* Whether all outputs can be written, and are neither each other nor a scene, before anything is computed.
 * That they are no other input is seen when that is read. */
static enum status check_files(const struct options *options)
{
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < options->output_count && status == STATUS_DONE; ++i)
        status = image_write_check(options->outputs[i]);
    for (const struct option_entry *option = option_table; option->help && status == STATUS_DONE; ++option) {
        if (option->read != read_output_file)
            continue;
        const char *path = *(const char *const *)((const char *)options + option->offset);
        if (path && !(path == options->heatmap && options_heatmap_folder(options)))
            status = output_file_claim(path);
    }
    for (size_t i = 0; i < options->scene_count && status == STATUS_DONE; ++i) {
        struct stat identity;
        const char *scene = options->scenes[i];
        const char *output = stat(scene, &identity) == 0 ? output_file_claimed(&identity) : NULL;
        if (output) {
            log_error("%s: is read, and is to be written as %s", scene, output);
            status = STATUS_REFUSED;
        }
    }
    return status;
}

enum status command_line_read(int argc, char **argv, struct options *options)
{
    *options = (struct options){.argc = argc, .argv = argv, .job = {.max_bounces = -1, .samples = 1}};
    options->outputs = calloc((size_t)argc, sizeof *options->outputs);
    options->found = calloc((size_t)argc, sizeof *options->found);
    if (!options->outputs || !options->found) {
        log_error("no memory for the command line");
        return STATUS_UNABLE;
    }
    options->help =
        strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0;
    options->version = strcmp(argv[1], "--version") == 0;
    if (options->help || options->version)
        return STATUS_DONE;
    enum status status = read_command(argv[1], options);
    if (status == STATUS_DONE)
        status = read_options(argc - 1, argv + 1, options);
    if (status != STATUS_DONE || options->help || options->version)
        return status;
    log_set_verbosity(options->job.plan.quiet ? -1 : options->verbose ? 1 : 0);
    options->job.plan.count_rays = options->stats != NULL;
    if (options->shaders.path && options->command != COMMAND_WATCH) /* which follows its files */
        options->job.plan.shaders = &options->shaders;
    if (options->command == COMMAND_WATCH && options->output_count == 0)
        options->window = options->window || getenv("DISPLAY") || getenv("WAYLAND_DISPLAY");
    status = check_consistency(options);
    if (options->picture && options->against == PRECISION_FLOAT)
        options->against = PRECISION_DOUBLE;
    if (status == STATUS_DONE && options->command == COMMAND_PIXEL)
        status = read_place(options);
    if (status == STATUS_DONE)
        status = find_scenes(options);
    return status == STATUS_DONE ? check_files(options) : status;
}

void options_destroy(struct options *options)
{
    for (char **found = options->found; found && *found; ++found)
        free(*found);
    free(options->found);
    free(options->outputs);
    shader_folder_destroy(&options->shaders);
}
