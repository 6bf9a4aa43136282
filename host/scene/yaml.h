#ifndef VKWHITTED_SCENE_YAML_H
#define VKWHITTED_SCENE_YAML_H

#include "scene/diagnostics.h"

/* A YAML document as a tree that remembers where everything stands. */

enum yaml_type {
    YAML_SCALAR,
    YAML_SEQUENCE,
    YAML_MAPPING,
    YAML_BROKEN, /* its error has been reported */
};

struct yaml_node {
    enum yaml_type type;
    struct scene_place place; /* of an alias: where the alias stands */
    bool plain;               /* scalar: written without quotes or block style */
    const char *text;         /* scalar: not terminated, may hold any bytes */
    size_t length;
    size_t count;                  /* sequence: items; mapping: keys and values */
    const struct yaml_node *child; /* sequence: first item; mapping: first key, its ->next is the value */
    struct yaml_node *next;        /* within the parent */
};

struct yaml_block;

struct yaml_tree {
    const struct yaml_node *root;
    struct yaml_block *blocks; /* memory of all nodes and texts */
};

/* Parses report->text, one YAML 1.2 document in UTF-8, and reports every error there. tree->root stays NULL
 * where the text has no document or breaks YAML's syntax. Aliases are resolved, tags refused. In any case
 * the caller frees the tree with yaml_free(). */
void yaml_parse(struct diagnostics *report, struct yaml_tree *tree);

void yaml_free(struct yaml_tree *tree);

/* An unquoted nothing: what stands behind "key:" at the end of a line. */
bool yaml_is_empty(const struct yaml_node *node);

#endif
