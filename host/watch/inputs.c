#include "watch/inputs.h"

#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <fts.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/installation.h"
#include "base/text_file.h"
#include "scene/scene.h"
#include "tracer/shader_folder.h"

/* How long, in milliseconds, a file that has been changed must stay as it is: it is known that nobody has it
 * open for writing; it is not known; somebody has. */
static const double closed_ms = 20, unknown_ms = 200, open_ms = 1000;

/* How old a change must be for the next one to get another time: most file systems count in 10 ms or less,
 * some in 2 s. */
static const double fine_ms = 20, coarse_ms = 2000;

enum { MOST_FOLDERS_DEEP = 3 };

/* A look at files. */
struct look {
    struct inputs_state state;
    struct timespec now, newest; /* newest: when one was changed or renamed last */
    double settling_ms;          /* how long they must stay as they are */
};

static double milliseconds_between(struct timespec from, struct timespec to)
{
    return (double)(to.tv_sec - from.tv_sec) * 1e3 + (double)(to.tv_nsec - from.tv_nsec) * 1e-6;
}

/* FNV-1a. */
static uint64_t hash(uint64_t so_far, const void *bytes, size_t size)
{
    for (const unsigned char *at = bytes; size > 0; ++at, --size)
        so_far = (so_far ^ *at) * UINT64_C(0x100000001b3);
    return so_far;
}

/* A lease for reading is given where nobody has the file open for writing. */
static double settling_time(const char *path)
{
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    bool closed = file >= 0 && fcntl(file, F_SETLEASE, F_RDLCK) == 0;
    double time_ms = closed ? closed_ms : file >= 0 && errno == EAGAIN ? open_ms : unknown_ms;
    if (file >= 0)
        close(file); /* and the lease ends */
    return time_ms;
}

/* A number for the file and its state. */
static uint64_t look_at(struct look *look, const char *path)
{
    struct stat about;
    uint64_t number = hash(UINT64_C(0xcbf29ce484222325), path, strlen(path));
    if (stat(path, &about) != 0) {
        look->settling_ms = fmax(look->settling_ms, unknown_ms);
        return number;
    }
    const int64_t facts[] = {(int64_t)about.st_dev, (int64_t)about.st_ino, (int64_t)about.st_size,
                             (int64_t)about.st_ctim.tv_sec, (int64_t)about.st_ctim.tv_nsec};
    if (milliseconds_between(look->newest, about.st_ctim) > 0)
        look->newest = about.st_ctim;
    if (milliseconds_between(about.st_ctim, look->now) < coarse_ms) /* settled already, if older */
        look->settling_ms = fmax(look->settling_ms, settling_time(path));
    return hash(number, facts, sizeof facts);
}

/* All that may be part of a shader, but for what is hidden. */
static uint64_t look_at_folder(struct look *look, const char *shader_path)
{
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(shader_path, '/') - shader_path), shader_path);
    uint64_t sum = 0; /* so that their order is all the same */
    FTS *tree = fts_open((char *const[]){folder, NULL}, FTS_LOGICAL | FTS_NOCHDIR, NULL);
    for (FTSENT *entry; tree && (entry = fts_read(tree));) {
        bool hidden = entry->fts_level > 0 && entry->fts_name[0] == '.';
        if (entry->fts_info == FTS_D && (hidden || entry->fts_level > MOST_FOLDERS_DEEP))
            fts_set(tree, entry, FTS_SKIP);
        else if (entry->fts_info == FTS_F && !hidden &&
                 fnmatch("*.@(comp|glsl|h)", entry->fts_name, FNM_EXTMATCH) == 0)
            sum += look_at(look, entry->fts_path);
    }
    if (tree)
        fts_close(tree);
    return sum;
}

static struct look look(const struct inputs *inputs)
{
    struct look look = {.settling_ms = closed_ms};
    clock_gettime(CLOCK_REALTIME, &look.now);
    look.state.of[INPUT_SCENE] = look_at(&look, inputs->scene_path);
    if (inputs->shader_broken)
        look.state.of[INPUT_SHADER] = look_at_folder(&look, inputs->shader_path);
    for (int kind = 0; kind < INPUT_KINDS; ++kind)
        for (const char *path = inputs->files[kind]; path && *path; path += strlen(path) + 1)
            look.state.of[kind] += look_at(&look, path);
    return look;
}

static bool same_state(struct inputs_state a, struct inputs_state b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

bool inputs_take(struct inputs *inputs, double *saved_ms)
{
    const struct look found = look(inputs);
    double now_ms = clock_ms(), age_ms = milliseconds_between(found.newest, found.now);
    if (!same_state(found.state, inputs->seen)) {
        /* since the last look, though no file is newer where one has gone or a link leads elsewhere */
        inputs->saved_ms = fmin(fmax(now_ms - age_ms, inputs->last_look_ms), now_ms);
        inputs->seen = found.state;
        inputs->unchanged_since_ms = now_ms;
    }
    inputs->last_look_ms = now_ms;
    double unchanged_ms = now_ms - inputs->unchanged_since_ms;
    bool dated = age_ms >= (found.newest.tv_nsec == 0 ? coarse_ms : fine_ms) ||
                 unchanged_ms >= coarse_ms; /* the file system's clock is ahead */
    if (same_state(found.state, inputs->taken) || unchanged_ms < found.settling_ms || !dated)
        return false;
    inputs->taken = found.state;
    *saved_ms = inputs->saved_ms;
    return true;
}

bool inputs_hold(const struct inputs *inputs)
{
    return same_state(look(inputs).state, inputs->taken);
}

bool inputs_follow(struct inputs *inputs, enum input_kind kind, char **files)
{
    free(inputs->files[kind]);
    inputs->files[kind] = *files;
    *files = NULL;
    const struct look found = look(inputs);
    const double now_ms = clock_ms(), age_ms = milliseconds_between(found.newest, found.now);
    inputs->taken.of[kind] = found.state.of[kind];
    const bool others_hold = same_state(found.state, inputs->taken);
    /* The files' clock may lag by half a tick; it may also be ahead. */
    const bool is_older =
        age_ms < 0 || (age_ms >= found.settling_ms && age_ms >= now_ms - inputs->last_look_ms + fine_ms / 2);
    inputs->seen = found.state;
    if (others_hold && is_older)
        return true;
    inputs->taken = (struct inputs_state){0};
    inputs->unchanged_since_ms = now_ms;
    return false;
}

char *inputs_read_scene(const struct inputs *inputs, size_t *length)
{
    char *text = text_file_read(inputs->scene_path, true, SCENE_MAX_FILE_SIZE, length);
    const int error = errno;
    if (!text)
        scene_refuse_file(inputs->scene_path, error);
    errno = error;
    return text;
}

enum status inputs_create(const char *scene_path, const char *shader_folder, struct inputs *inputs)
{
    char found[PATH_MAX];
    *inputs = (struct inputs){.scene_path = scene_path, .shader_broken = true, .last_look_ms = INFINITY};
    if (!shader_folder)
        installation_find("shaders", found);
    signal(SIGIO, SIG_IGN); /* comes where somebody opens a file for writing while we hold a lease */
    size_t scene_length;
    char *scene = inputs_read_scene(inputs, &scene_length);
    enum status status = scene ? shader_path(shader_folder ? shader_folder : found, inputs->shader_path)
                               : input_file_status(errno);
    free(scene);
    return status;
}

void inputs_destroy(struct inputs *inputs)
{
    for (int kind = 0; kind < INPUT_KINDS; ++kind)
        free(inputs->files[kind]);
    *inputs = (struct inputs){0};
}
