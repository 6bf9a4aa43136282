#include "cli/scene_name.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/installation.h"

static const char suffix[] = ".yaml";

static bool is_scene(const char *name)
{
    const char *end = strrchr(name, '.');
    return end && end > name && strcmp(end, suffix) == 0;
}

char *scene_name_find(const char *name)
{
    char folder[PATH_MAX], *path;
    installation_find("scenes", folder);
    if (access(name, F_OK) == 0 || name[0] == '/' || name[0] == '.' ||
        asprintf(&path, "%s/%s%s", folder, name, is_scene(name) ? "" : suffix) < 0)
        return NULL;
    if (access(path, F_OK) == 0)
        return path;
    free(path);
    return NULL;
}

static int is_scene_entry(const struct dirent *entry)
{
    return is_scene(entry->d_name);
}

char *scene_name_list(void)
{
    char folder[PATH_MAX], *text = NULL;
    size_t size;
    struct dirent **entries = NULL;
    installation_find("scenes", folder);
    const int count = scandir(folder, &entries, is_scene_entry, alphasort);
    FILE *stream = open_memstream(&text, &size);
    if (stream) {
        fputs("a scene file", stream);
        for (int i = 0; i < count; ++i)
            fprintf(stream, "%s%.*s", i == 0 ? ", or one of the program's: " : ", ",
                    (int)(strrchr(entries[i]->d_name, '.') - entries[i]->d_name), entries[i]->d_name);
        if (count > 0)
            fprintf(stream, " (all: %s)", folder);
        fclose(stream);
    }
    for (int i = 0; i < count; ++i)
        free(entries[i]);
    free(entries);
    return text;
}
