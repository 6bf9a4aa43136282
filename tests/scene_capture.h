#ifndef VKWHITTED_SCENE_CAPTURE_H
#define VKWHITTED_SCENE_CAPTURE_H

/* Reading scenes with what is said about them kept. Include after cmocka.h. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/scene.h"

static char messages[1 << 16]; /* what the latest read printed to standard error */

static FILE *start_capture(int *saved)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stderr);
    *saved = dup(STDERR_FILENO);
    assert_true(dup2(fileno(file), STDERR_FILENO) >= 0);
    return file;
}

static void end_capture(FILE *file, int saved)
{
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    rewind(file);
    messages[fread(messages, 1, sizeof(messages) - 1, file)] = '\0';
    fclose(file);
}

static enum status read_bytes(const char *text, size_t length, struct scene *scene)
{
    int saved;
    FILE *file = start_capture(&saved);
    char *copy = malloc(length + 1); /* without a terminator, so that a read past the end is noticed */
    assert_non_null(copy);
    memcpy(copy, text, length);
    enum status status = scene_read_text("bad.yaml", copy, length, scene);
    free(copy);
    end_capture(file, saved);
    return status;
}

static enum status read_text(const char *text, struct scene *scene)
{
    return read_bytes(text, strlen(text), scene);
}

static inline enum status read_file(const char *path, struct scene *scene)
{
    int saved;
    FILE *file = start_capture(&saved);
    enum status status = scene_read(path, scene);
    end_capture(file, saved);
    return status;
}

static inline void read_good(const char *text, struct scene *scene)
{
    if (read_text(text, scene) != STATUS_DONE)
        fail_msg("refused: %s", messages);
    assert_string_equal(messages, "");
}

#endif
