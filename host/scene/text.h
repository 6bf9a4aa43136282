#ifndef VKWHITTED_SCENE_TEXT_H
#define VKWHITTED_SCENE_TEXT_H

#include "scene/scene.h"

/* scene_read() for a scene file's content in memory; path is for the messages and for scene->path. */
enum status scene_read_text(const char *path, const char *text, size_t length, struct scene *scene);

#endif
