#include "scene/spheres_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The path of a file that a scene file names, allocated; NULL without memory. */
static char *resolve(const char *scene_path, const char *name)
{
    const char *slash = strrchr(scene_path, '/');
    int folder = name[0] == '/' || !slash ? 0 : (int)(slash + 1 - scene_path);
    char *path;
    return asprintf(&path, "%.*s%s", folder, scene_path, name) < 0 ? NULL : path;
}

void spheres_file_read(struct mapping *mapping, const struct npy_column columns[NPY_COLUMNS], size_t most,
                       struct scene_object *object)
{
    const struct yaml_value value = schema_find(mapping, "file");
    char *name = NULL, message[NPY_MESSAGE];
    if (!value.written)
        return;
    read_name(mapping, &(struct field){.name = "file"}, &value, &name);
    char *path = name ? resolve(mapping->report->path, name) : NULL;
    mapping->report->no_memory |= name && !path;
    enum status status =
        path ? npy_read(path, columns, most, &object->spheres.rows, &object->spheres.count, message)
             : STATUS_DONE;
    if (status != STATUS_DONE)
        schema_refuse(mapping, value.written, "%s: %s", name, message);
    mapping->report->unable |= status == STATUS_UNABLE;
    free(name);
    free(path);
}

static struct yaml_value find(struct diagnostics *report, const struct yaml_value *value, const char *key)
{
    return schema_find(&(struct mapping){.report = report, .value = *value}, key);
}

char *scene_list_files(const char *path, const char *text, size_t length)
{
    struct diagnostics report = {.path = path, .text = text, .length = length};
    struct fy_document *document = yaml_load(&report);
    char *list = NULL;
    size_t list_length = 0;
    FILE *stream = open_memstream(&list, &list_length); /* which puts a 0 at the end */
    if (document && stream) {
        const struct yaml_value root = yaml_read(&report, fy_document_root(document), NULL);
        const struct yaml_value objects = find(&report, &root, "objects");
        struct fy_node *item;
        for (void *at = NULL; (item = fy_node_sequence_iterate(objects.node, &at));) {
            const struct yaml_value object = yaml_read(&report, item, NULL);
            const struct yaml_value file = find(&report, &object, "file");
            char *found = file.type == FYNT_SCALAR && file.length > 0 && file.length < YAML_TEXT_SIZE
                              ? resolve(path, file.text)
                              : NULL;
            if (found)
                fwrite(found, 1, strlen(found) + 1, stream);
            free(found);
        }
    }
    fy_document_destroy(document);
    report_discard(&report);
    if (stream && fclose(stream) == 0 && list_length > 0)
        return list;
    free(list);
    return NULL;
}
