#include "cli/option_table.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

bool parse_list(const char *text, char separator, size_t count, unsigned long most, unsigned *values)
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

static bool refuse(const struct option_entry *option, const char *value, const char *expected)
{
    log_error("--%s %s: expected %s", option->name, value, expected);
    return false;
}

static bool read_flag(const struct option_entry *option, const char *value, void *place)
{
    (void)option, (void)value;
    *(bool *)place = true;
    return true;
}

static bool read_text(const struct option_entry *option, const char *value, void *place)
{
    (void)option;
    *(const char **)place = value;
    return true;
}

bool read_output_file(const struct option_entry *option, const char *value, void *place)
{
    return read_text(option, value, place);
}

static bool read_output(const struct option_entry *option, const char *value, void *place)
{
    (void)option;
    struct options *options = place;
    options->outputs[options->output_count++] = value;
    return true;
}

static bool read_number(const struct option_entry *option, const char *value, void *place)
{
    unsigned number;
    char expected[64];
    snprintf(expected, sizeof expected, "a whole number from %u to %u", option->least, option->most);
    if (!parse_list(value, 0, 1, option->most, &number) || number < option->least)
        return refuse(option, value, expected);
    memcpy(place, &number, sizeof number); /* to an unsigned, or an int that holds it */
    return true;
}

/* The number of the word, the first being `least`, becomes the value of an enumeration. */
static bool read_choice(const struct option_entry *option, const char *value, void *place)
{
    char expected[64] = "";
    unsigned number = option->least;
    for (const char *word = option->value;; ++number) {
        size_t length = strcspn(word, "|");
        if (strlen(value) == length && memcmp(value, word, length) == 0)
            break;
        snprintf(expected + strlen(expected), sizeof expected - strlen(expected), "%s%.*s",
                 expected[0] ? " or " : "", (int)length, word);
        if (!word[length])
            return refuse(option, value, expected);
        word += length + 1;
    }
    memcpy(place, &number, sizeof number);
    return true;
}
_Static_assert(sizeof(enum precision) == sizeof(unsigned) && sizeof(enum backend) == sizeof(unsigned) &&
                   sizeof(enum transfer) == sizeof(unsigned),
               "as read_choice() writes them");

static bool read_size(const struct option_entry *option, const char *value, void *place)
{
    struct options *options = place;
    unsigned size[2];
    if (!parse_list(value, 'x', 2, SCENE_MAX_SIZE, size) || size[0] == 0 || size[1] == 0)
        return refuse(option, value, "WIDTHxHEIGHT, each from 1 to 65536");
    options->job.width = size[0];
    options->job.height = size[1];
    return true;
}

static bool read_crop(const struct option_entry *option, const char *value, void *place)
{
    struct options *options = place;
    unsigned crop[4];
    if (!parse_list(value, ',', 4, SCENE_MAX_SIZE, crop) || crop[2] == 0 || crop[3] == 0)
        return refuse(option, value,
                      "X,Y,WIDTH,HEIGHT in pixels from the top left, width and height at least 1");
    options->job.plan.window = (struct window){crop[0], crop[1], crop[2], crop[3]};
    return true;
}

static bool read_tile(const struct option_entry *option, const char *value, void *place)
{
    struct job_options *job = &((struct options *)place)->job;
    unsigned tile[2];
    if (!parse_list(value, '/', 2, TILE_MOST, tile) || tile[0] < 1 || tile[0] > tile[1])
        return refuse(option, value, "I/N, the Ith of N tiles, I from 1 to N");
    job->tile = (struct tile){.number = tile[0], .count = tile[1]};
    return true;
}

static bool read_max_error(const struct option_entry *option, const char *value, void *place)
{
    struct job_options *job = &((struct options *)place)->job;
    job->has_max_error = parse_double(value, strlen(value), &job->max_error) && job->max_error >= 0;
    return job->has_max_error || refuse(option, value, "a radiance, not negative");
}

static bool read_tolerance(const struct option_entry *option, const char *value, void *place)
{
    struct options *options = place;
    struct tolerance *tolerance = &options->tolerance;
    const char *comma = strchrnul(value, ',');
    *tolerance = (struct tolerance){0, 0};
    options->has_tolerance =
        parse_double(value, (size_t)(comma - value), &tolerance->absolute) && tolerance->absolute >= 0 &&
        (!*comma ||
         (parse_double(comma + 1, strlen(comma + 1), &tolerance->relative) && tolerance->relative >= 0));
    return options->has_tolerance || refuse(option, value, "ABSOLUTE or ABSOLUTE,RELATIVE, not negative");
}

enum {
    RENDER = 1 << COMMAND_RENDER,
    JOIN = 1 << COMMAND_JOIN,
    CHECK = 1 << COMMAND_CHECK,
    WATCH = 1 << COMMAND_WATCH,
    BENCH = 1 << COMMAND_BENCH,
    PIXEL = 1 << COMMAND_PIXEL,
    ALL = (1 << COMMAND_COUNT) - 1,
};

/* The members from `value` to `most`. */
#define FLAG(member) NULL, read_flag, offsetof(struct options, member), 0, 0
#define TEXT(value, member) value, read_text, offsetof(struct options, member), 0, 0
#define OUTPUT(value, member) value, read_output_file, offsetof(struct options, member), 0, 0
#define NUMBER(member, least, most) "N", read_number, offsetof(struct options, member), least, most
#define CHOICE(words, member, first) words, read_choice, offsetof(struct options, member), first, 0
#define OTHER(value, read) value, read, 0, 0, 0 /* read() gets the whole struct options */

const struct option_entry option_table[] = {
    {"size", "", RENDER | CHECK | WATCH | BENCH | PIXEL, OTHER("WxH", read_size),
     "pixels of the picture, instead of the scene's"},
    {"shaders", "", RENDER | CHECK | WATCH | BENCH | PIXEL, TEXT("DIR", shaders.path),
     "the folder of a whitted.comp, which is compiled now, in the\n"
     "place of the program's own"},

    {"max-bounces", "", RENDER | CHECK | WATCH | PIXEL, NUMBER(job.max_bounces, 0, SCENE_MAX_BOUNCES),
     "bounces after which a ray is black, instead of the scene's"},
    {"samples", "", RENDER | CHECK | WATCH | PIXEL, NUMBER(job.samples, 1, SCENE_MAX_SAMPLES),
     "samples a pixel (default: the pixel's centre)"},
    {"light-samples", "", RENDER | CHECK | WATCH | PIXEL, NUMBER(job.light_samples, 1, SCENE_MAX_SAMPLES),
     "samples of a quad light at a point, instead of the scene's"},
    {"max-error", "", RENDER | CHECK | WATCH | PIXEL, OTHER("E", read_max_error),
     "leave out rays that together change no channel of a pixel by\n"
     "more than E in linear radiance; raise --max-bounces with it"},
    {"precision", "", RENDER | CHECK | WATCH | PIXEL,
     CHOICE("float|double|quad", job.plan.precision, PRECISION_FLOAT),
     "double on a device that has it, quad (binary128) on the CPU"},

    {"crop", "", RENDER | CHECK | WATCH, OTHER("X,Y,W,H", read_crop),
     "only this part of the picture, in pixels from the top left"},
    {"fast", "", RENDER | CHECK | WATCH, FLAG(job.plan.fast),
     "contraction and built-in functions allowed on the device"},
    {"threads", "", RENDER | CHECK | WATCH, NUMBER(job.plan.threads, 1, 1024),
     "of the CPU reference (default: one a processor)"},

    {"backend", "", RENDER | CHECK | BENCH, CHOICE("vulkan|cpu", backend, BACKEND_VULKAN),
     "cpu: the plain-C reference, no device (check: with --against)"},

    {"", "o", RENDER | JOIN | WATCH, OTHER("FILE", read_output),
     "write the picture; may be given several times"},
    {"transfer", "", RENDER | JOIN | WATCH | CHECK, CHOICE("srgb|linear", transfer, TRANSFER_SRGB),
     "of 8-bit files (default srgb)"},

    {"tile", "", RENDER, OTHER("I/N", read_tile),
     "only the Ith of N parts of the picture, from 1, as .exr;\n"
     "join makes one picture of all of them"},
    {"stats", "", RENDER, OUTPUT("FILE", stats), "times, rays and device as JSON"},
    {"repeat", "", RENDER, NUMBER(job.plan.repeat, 1, 100000),
     "render again as often; the time is the median of these"},

    {"tolerance", "", CHECK, OTHER("ABS[,REL]", read_tolerance),
     "a and b agree where |a - b| <= ABS + REL max(|a|, |b|)\n"
     "(default: where they are the same bits)"},
    {"allow", "", CHECK, NUMBER(allow, 0, UINT_MAX), "pixels that may differ or be unexplained"},
    {"heatmap", "", CHECK, OUTPUT("FILE.png", heatmap),
     "where they differ, as a picture; DIR/: one for each scene\n"
     "that differs, in that folder"},
    {"picture", "", CHECK, TEXT("FILE", picture),
     "judge this picture (.exr, .pfm, .png) by any other program\n"
     "instead of one's own (default --against double)"},
    {"junit", "", CHECK, OUTPUT("FILE.xml", junit), "the result for CI, a test case a scene"},

    {"against", "", CHECK | PIXEL, CHOICE("double|quad", against, PRECISION_DOUBLE),
     "judge the float picture by a more precise one: errors, their\n"
     "bounds, and pixels that are beyond them"},

    {"json", "", CHECK | PIXEL | BENCH, OUTPUT("FILE", json), "the result for machines"},

    {"check", "", WATCH, FLAG(check), "compare each picture with the reference in the background"},
    {"window", "", WATCH, FLAG(window),
     "show it in a window (default on a display, without -o): drag,\n"
     "Shift-drag and wheel move the camera, R resets and P prints it,\n"
     "S saves the picture, D shows where it differs, Esc ends"},

    {"quick", "", BENCH, FLAG(quick), "fewer settings and runs: half a minute a scene"},
    {"report", "", BENCH, OUTPUT("FILE.html", report), "all of it on one page, with charts"},
    {"csv", "", BENCH, OUTPUT("FILE", csv), "the measurements, one a line"},
    {"compare", "", BENCH, TEXT("OLD.json", compare),
     "what became faster, slower or less accurate beyond noise since\n"
     "the bench that wrote this with --json"},

    {"device", "", ALL & ~JOIN, TEXT("N|NAME", vulkan.device),
     "the device with this number, or with this in its name"},
    {"validate", "", ALL & ~JOIN, FLAG(vulkan.validate),
     "with the Khronos validation layer; any message is an error"},
    {"", "q", ALL, FLAG(job.plan.quiet), "quiet: errors only"},
    {"", "v", ALL, FLAG(verbose), "verbose: also the device; all light samples of a pixel"},
    {"help", "h", ALL, FLAG(help), "this text"},
    {"version", "", ALL, FLAG(version), "the program's version"},
    {0},
};
_Static_assert(sizeof option_table / sizeof *option_table <= OPTION_COUNT_MAX + 1, "for command_line.c");
