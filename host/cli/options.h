#ifndef VKWHITTED_CLI_OPTIONS_H
#define VKWHITTED_CLI_OPTIONS_H

#include <stdio.h>

#include "check/compare.h"
#include "tracer/job.h"
#include "tracer/shader_folder.h"
#include "vulkan/context.h"

enum command_id {
    COMMAND_RENDER,
    COMMAND_JOIN,
    COMMAND_CHECK,
    COMMAND_WATCH,
    COMMAND_BENCH,
    COMMAND_PIXEL,
    COMMAND_DEVICES,
    COMMAND_COUNT
};

/* The command line, checked. Strings point into argv. */
struct options {
    enum command_id command;
    int argc;
    char **argv;
    char **scenes; /* paths, of argv or of `found`; of tiles for join */
    size_t scene_count;
    char **found;         /* paths of scenes given by name, NULL behind the last */
    const char **outputs; /* -o */
    size_t output_count;
    struct vulkan_options vulkan;
    enum backend backend;
    struct job_options job;
    enum transfer transfer;
    bool has_tolerance;
    struct tolerance tolerance;
    unsigned allow; /* pixels that may differ */
    enum precision
        against; /* float: against the reference, bit for bit; otherwise against the exact picture */
    const char *stats, *json, *junit, *heatmap;
    const char *picture;                /* that check judges instead of one of its own */
    const char *csv, *report, *compare; /* bench; compare is the JSON file of an earlier one */
    bool quick;
    unsigned x, y;                /* of pixel */
    struct shader_folder shaders; /* without path: the program's own shader; the job's plan points to it */
    bool check;                   /* each picture that watch makes */
    bool window;                  /* that watch shows pictures in */
    bool verbose;
    bool help, version; /* is all that is asked for, and nothing else has been checked */
};

/* Reads the command line; argc is at least 2. STATUS_REFUSED (reported) if it is wrong, STATUS_UNABLE if an
 * output cannot be written. *options must stay where it is, and is destroyed by the caller, also on failure.
 */
enum status command_line_read(int argc, char **argv, struct options *options);

/* Whether --heatmap names a folder. */
bool options_heatmap_folder(const struct options *options);

/* How many of the outputs are EXR files. */
size_t options_exr_outputs(const struct options *options);

void options_destroy(struct options *options);

/* The caller finds out by fflush() whether the text could be written. documents.cmake reads it, too. */
void help_print(FILE *stream);
void help_print_version(void);

/* What is reported on standard output and error, and what the exit status means, stands in the manual page.
 */
enum status command_render(const struct options *options);
enum status command_join(const struct options *options);
enum status command_check(const struct options *options);
enum status command_watch(const struct options *options);
enum status command_bench(const struct options *options);
enum status command_pixel(const struct options *options);
enum status command_devices(const struct options *options);

struct command {
    const char *name, *arguments, *summary;
    enum status (*run)(const struct options *options);
};
extern const struct command commands[COMMAND_COUNT];

#endif
