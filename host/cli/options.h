#ifndef VKWHITTED_CLI_OPTIONS_H
#define VKWHITTED_CLI_OPTIONS_H

#include <stddef.h>

#include "check/compare.h"
#include "tracer/job.h"
#include "vulkan/context.h"

enum command {
    COMMAND_RENDER,
    COMMAND_CHECK,
    COMMAND_WATCH,
    COMMAND_BENCH,
    COMMAND_PIXEL,
    COMMAND_DEVICES,
    COMMAND_COUNT
};

/* The command line, checked. Strings point into argv. */
struct options {
    enum command command;
    int argc;
    char **argv;
    char **scenes; /* paths */
    size_t scene_count;
    const char **outputs; /* -o */
    size_t output_count;
    struct vulkan_options vulkan;
    enum backend backend;
    struct job_options job;
    enum transfer transfer;
    bool has_tolerance;
    struct tolerance tolerance;
    unsigned long allow; /* pixels that may differ */
    enum precision
        against; /* PRECISION_FLOAT: bit for bit against the reference, otherwise against the truth */
    const char *stats, *json, *heatmap;
    const char *csv, *report, *compare; /* bench; compare is an earlier one's JSON file */
    bool quick;
    unsigned x, y;       /* of pixel */
    const char *shaders; /* folder; NULL: the one that came with the program */
    bool check;          /* each picture that watch makes */
    bool window;         /* that watch shows pictures in */
    bool verbose;
};

/* Reads the command line; owns options->outputs, freed with options_destroy(). STATUS_REFUSED (reported) if
 * it is wrong. *finished is set where --help or --version has been answered and nothing is left to do. */
enum status options_read(int argc, char **argv, struct options *options, bool *finished);
void options_destroy(struct options *options);

#endif
