#ifndef VKWHITTED_SCENE_CAPTURE_H
#define VKWHITTED_SCENE_CAPTURE_H

/* Reading scenes; what is said about them is in test_messages then. Include after cmocka.h. */

#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"
#include "test_folder.h"

static enum status read_bytes(const char *text, size_t length, struct scene *scene)
{
    char line[256];
    test_messages_begin();
    char *copy = malloc(length + 1); /* without a terminator, so that a read past the end is noticed */
    assert_non_null(copy);
    memcpy(copy, text, length);
    enum status status = scene_read_text("bad.yaml", copy, length, scene);
    free(copy);
    test_messages_end(line);
    return status;
}

static enum status read_text(const char *text, struct scene *scene)
{
    return read_bytes(text, strlen(text), scene);
}

static inline enum status read_file(const char *path, struct scene *scene)
{
    char line[256];
    test_messages_begin();
    enum status status = scene_read(path, scene);
    test_messages_end(line);
    return status;
}

static inline void read_good(const char *text, struct scene *scene)
{
    if (read_text(text, scene) != STATUS_DONE)
        fail_msg("refused: %s", test_messages);
    assert_string_equal(test_messages, "");
}

#endif
