#ifndef VKWHITTED_SCENE_YAML_H
#define VKWHITTED_SCENE_YAML_H

#include <libfyaml.h>

#include "scene/diagnostics.h"

enum { YAML_TEXT_SIZE = 512 }; /* bytes, the terminator included */

/* What stands at a node of a document. */
struct yaml_value {
    struct fy_node *written, *node; /* differ for an alias: where it stands, and what it stands for */
    enum fy_node_type type;
    bool plain;    /* a scalar without quotes */
    size_t length; /* of the text; YAML_TEXT_SIZE: longer than anything in a scene, and cut */
    char text[YAML_TEXT_SIZE];
};

/* Parses report->text, one YAML 1.2 document in UTF-8 without tags, whose aliases are known. NULL where there
 * is none, or after an error (reported); the caller destroys it. */
struct fy_document *yaml_load(struct diagnostics *report);

/* On lack of memory this and the next function set report->no_memory. */
struct yaml_value yaml_read(struct diagnostics *report, struct fy_node *node);

/* Where the node is written. An empty value stands where its key does. Looking for an empty node takes long
 * in a long list. */
struct scene_place yaml_place(struct diagnostics *report, struct fy_node *node);

#endif
