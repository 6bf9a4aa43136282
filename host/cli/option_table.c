#include "cli/option_table.h"

#include <stddef.h>

#include "cli/options.h"

enum {
    RENDER = 1 << COMMAND_RENDER,
    CHECK = 1 << COMMAND_CHECK,
    WATCH = 1 << COMMAND_WATCH,
    BENCH = 1 << COMMAND_BENCH,
    PIXEL = 1 << COMMAND_PIXEL,
    DEVICES = 1 << COMMAND_DEVICES,
};

const struct option option_table[] = {
    {"device", required_argument, NULL, OPTION_DEVICE},
    {"backend", required_argument, NULL, OPTION_BACKEND},
    {"precision", required_argument, NULL, OPTION_PRECISION},
    {"fast", no_argument, NULL, OPTION_FAST},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"max-bounces", required_argument, NULL, OPTION_MAX_BOUNCES},
    {"samples", required_argument, NULL, OPTION_SAMPLES},
    {"light-samples", required_argument, NULL, OPTION_LIGHT_SAMPLES},
    {"max-error", required_argument, NULL, OPTION_MAX_ERROR},
    {"crop", required_argument, NULL, OPTION_CROP},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"transfer", required_argument, NULL, OPTION_TRANSFER},
    {"validate", no_argument, NULL, OPTION_VALIDATE},
    {"stats", required_argument, NULL, OPTION_STATS},
    {"repeat", required_argument, NULL, OPTION_REPEAT},
    {"tolerance", required_argument, NULL, OPTION_TOLERANCE},
    {"allow", required_argument, NULL, OPTION_ALLOW},
    {"against", required_argument, NULL, OPTION_AGAINST},
    {"heatmap", required_argument, NULL, OPTION_HEATMAP},
    {"json", required_argument, NULL, OPTION_JSON},
    {"csv", required_argument, NULL, OPTION_CSV},
    {"report", required_argument, NULL, OPTION_REPORT},
    {"compare", required_argument, NULL, OPTION_COMPARE},
    {"quick", no_argument, NULL, OPTION_QUICK},
    {"shaders", required_argument, NULL, OPTION_SHADERS},
    {"check", no_argument, NULL, OPTION_CHECK},
    {"window", no_argument, NULL, OPTION_WINDOW},
    {"help", no_argument, NULL, OPTION_HELP},
    {"version", no_argument, NULL, OPTION_VERSION},
    {0},
};

int option_takers(int id)
{
    switch (id) {
    case 'o':
    case OPTION_TRANSFER:
        return RENDER | WATCH;
    case OPTION_STATS:
    case OPTION_REPEAT:
        return RENDER;
    case OPTION_SHADERS:
    case OPTION_CHECK:
    case OPTION_WINDOW:
        return WATCH;
    case OPTION_TOLERANCE:
    case OPTION_ALLOW:
    case OPTION_HEATMAP:
        return CHECK;
    case OPTION_AGAINST:
        return CHECK | PIXEL;
    case OPTION_JSON:
        return CHECK | BENCH | PIXEL;
    case OPTION_CSV:
    case OPTION_REPORT:
    case OPTION_COMPARE:
    case OPTION_QUICK:
        return BENCH;
    case OPTION_BACKEND:
        return RENDER | CHECK | BENCH;
    case OPTION_SIZE:
        return RENDER | CHECK | WATCH | BENCH | PIXEL;
    case OPTION_DEVICE:
    case OPTION_VALIDATE:
    case 'q':
    case 'v':
    case 'h':
    case OPTION_HELP:
    case OPTION_VERSION:
        return RENDER | CHECK | WATCH | BENCH | PIXEL | DEVICES;
    case OPTION_FAST:
    case OPTION_CROP:
    case OPTION_THREADS:
        return RENDER | CHECK | WATCH;
    default:
        return RENDER | CHECK | WATCH | PIXEL;
    }
}

const char *option_name(int id)
{
    for (const struct option *option = option_table; option->name; ++option)
        if (option->val == id)
            return option->name;
    return "";
}
