#include "watch/inputs.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/clock.h"
#include "base/text_file.h"

enum {
    MOST_SCENE_BYTES = 16 << 20, /* as scene_read() */
    MOST_READINGS = 4,           /* of files that go on changing */
};

static const double look_again_ms = 1000;

enum status watch_inputs_create(const char *scene_path, const char *shader_path, struct watch_inputs *inputs)
{
    *inputs = (struct watch_inputs){.scene_path = scene_path, .shader_path = shader_path};
    return file_watch_create(&inputs->files);
}

static void forget(struct watch_inputs *inputs)
{
    free(inputs->scene);
    shader_source_destroy(&inputs->shader);
}

void watch_inputs_destroy(struct watch_inputs *inputs)
{
    forget(inputs);
    file_watch_destroy(&inputs->files);
    *inputs = (struct watch_inputs){0};
}

static enum status read_files(struct watch_inputs *inputs)
{
    errno = 0;
    inputs->scene = text_file_read(inputs->scene_path, true, MOST_SCENE_BYTES, &inputs->scene_length);
    inputs->scene_error = inputs->scene ? 0 : errno;
    return shader_source_read(inputs->shader_path, &inputs->shader);
}

/* Watches what has been read. Returns whether it was not all watched while it was read. */
static bool watch_files(struct watch_inputs *inputs)
{
    const struct shader_source *shader = &inputs->shader;
    char **paths = calloc(shader->file_count + 1, sizeof *paths);
    if (!paths)
        return false;
    paths[0] = (char *)inputs->scene_path;
    memcpy(paths + 1, shader->files, shader->file_count * sizeof *paths);
    bool added = file_watch_set(inputs->files, paths, shader->file_count + 1);
    free(paths);
    return added;
}

static bool same_scene(const struct watch_inputs *a, const struct watch_inputs *b)
{
    if (!a->scene || !b->scene)
        return !a->scene && !b->scene && a->scene_error == b->scene_error;
    return a->scene_length == b->scene_length && memcmp(a->scene, b->scene, a->scene_length) == 0;
}

static bool same_shader(const struct shader_source *a, const struct shader_source *b)
{
    return a->text && b->text && a->length == b->length && memcmp(a->text, b->text, a->length) == 0;
}

/* When a file that is there was last changed or renamed, by clock_ms(), to the few milliseconds that file
 * systems resolve. */
static double newest_change_ms(const struct watch_inputs *inputs)
{
    struct timespec now;
    struct stat about;
    double age_ms = INFINITY;
    clock_gettime(CLOCK_REALTIME, &now);
    for (size_t i = 0; i <= inputs->shader.file_count; ++i) {
        const char *path = i < inputs->shader.file_count ? inputs->shader.files[i] : inputs->scene_path;
        if (stat(path, &about) == 0)
            age_ms = fmin(age_ms, (double)(now.tv_sec - about.st_ctim.tv_sec) * 1e3 +
                                      (double)(now.tv_nsec - about.st_ctim.tv_nsec) * 1e-6);
    }
    return clock_ms() - fmax(age_ms, 0);
}

/* When what has changed was saved. Where no file is newer than the last look, one has gone, or a link leads
 * elsewhere. */
static double saved_ms(const struct watch_inputs *inputs, double last_look_ms)
{
    double changed_ms = newest_change_ms(inputs), event_ms = file_watch_last_event_ms(inputs->files);
    return changed_ms > last_look_ms ? changed_ms : event_ms > last_look_ms ? event_ms : clock_ms();
}

enum status watch_inputs_read(struct watch_inputs *inputs, bool happened, struct watch_changes *changes)
{
    *changes = (struct watch_changes){0};
    if (!happened && inputs->shader.text && clock_ms() - inputs->last_look_ms < look_again_ms)
        return STATUS_DONE;
    struct watch_inputs before = *inputs;
    enum status status = STATUS_DONE;
    inputs->scene = NULL;
    inputs->shader = (struct shader_source){0};
    for (int i = 0; i < MOST_READINGS && status == STATUS_DONE; ++i) {
        if (happened)
            file_watch_settle(inputs->files);
        forget(inputs);
        status = read_files(inputs);
        happened = file_watch_wait(inputs->files, 0);
        if (status == STATUS_DONE && !watch_files(inputs) && !happened)
            break;
    }
    inputs->last_look_ms = clock_ms();
    changes->scene = !before.shader.text || !same_scene(inputs, &before);
    changes->shader = !same_shader(&inputs->shader, &before.shader);
    changes->saved_ms = saved_ms(inputs, before.last_look_ms);
    forget(&before);
    return status;
}
