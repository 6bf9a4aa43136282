#ifndef VKWHITTED_CLI_OPTIONS_H
#define VKWHITTED_CLI_OPTIONS_H

#include <stddef.h>

#include "check/compare.h"
#include "cli/commands.h"
#include "tracer/job.h"
#include "vulkan/context.h"

/* The command line, checked. Strings point into argv. */
struct options {
    enum command_id command;
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
    unsigned allow; /* pixels that may differ */
    enum precision
        against; /* float: against the reference, bit for bit; otherwise against the exact picture */
    const char *stats, *json, *heatmap;
    const char *csv, *report, *compare; /* bench; compare is the JSON file of an earlier one */
    bool quick;
    unsigned x, y;       /* of pixel */
    const char *shaders; /* folder; NULL: the one that came with the program */
    bool check;          /* each picture that watch makes */
    bool window;         /* that watch shows pictures in */
    bool verbose;
    bool help, version; /* is all that is asked for, and nothing else has been checked */
};

#endif
