#ifndef VKWHITTED_CLI_OPTION_TABLE_H
#define VKWHITTED_CLI_OPTION_TABLE_H

#include <getopt.h>

/* Options are known by their letter or by one of these. */
enum option_id {
    OPTION_FIRST = 256, /* above all letters */
    OPTION_DEVICE = OPTION_FIRST,
    OPTION_BACKEND,
    OPTION_PRECISION,
    OPTION_FAST,
    OPTION_SIZE,
    OPTION_MAX_BOUNCES,
    OPTION_SAMPLES,
    OPTION_LIGHT_SAMPLES,
    OPTION_MAX_ERROR,
    OPTION_CROP,
    OPTION_THREADS,
    OPTION_TRANSFER,
    OPTION_VALIDATE,
    OPTION_STATS,
    OPTION_REPEAT,
    OPTION_TOLERANCE,
    OPTION_ALLOW,
    OPTION_AGAINST,
    OPTION_HEATMAP,
    OPTION_JSON,
    OPTION_CSV,
    OPTION_REPORT,
    OPTION_COMPARE,
    OPTION_QUICK,
    OPTION_SHADERS,
    OPTION_CHECK,
    OPTION_WINDOW,
    OPTION_HELP,
    OPTION_VERSION,
};

/* For getopt_long(). */
extern const struct option option_table[];

/* Which commands take the option: a set of bits, 1 << COMMAND_. */
int option_takers(int id);

/* The long name, "" for a letter. */
const char *option_name(int id);

#endif
