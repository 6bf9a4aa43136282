#ifndef VKWHITTED_SCENE_SCHEMA_H
#define VKWHITTED_SCENE_SCHEMA_H

#include <stdint.h>

#include "scene/yaml.h"

/* Which keys a mapping of a scene file takes, and reading such a mapping into a struct. */

enum { SCHEMA_MAX_FIELDS = 16 };

/* A bound on a number, with the words for "must be ...". Lists of bounds end with one without a rule. */
struct bound {
    double least, most;
    bool open; /* least and most themselves are outside */
    const char *rule;
};

enum field_kind {
    FIELD_NODE,   /* only found, not read */
    FIELD_TYPE,   /* one of schema.types; goes to mapping.type */
    FIELD_NAME,   /* char *, allocated, not empty, no control characters */
    FIELD_NUMBER, /* double */
    FIELD_VECTOR, /* double[3] */
    FIELD_COUNT,  /* unsigned */
};

struct field {
    const char *name;
    enum field_kind kind;
    bool required;
    unsigned types; /* bit set of the types that take it; 0: all */
    size_t offset;  /* in the struct read into */
    const struct bound *bounds;
};

struct schema {
    const char *label;         /* "object" */
    const char *const *types;  /* NULL where there is no key "type" */
    const char *const *labels; /* of the types: "sphere", "plane" */
    size_t type_count;
    const struct field *fields;
    size_t field_count;
};

/* What was found of a mapping. */
struct mapping {
    const struct yaml_node *node;
    char label[2 * REPORT_QUOTE_SIZE];                 /* begins its messages: "sphere "Ball": " */
    int type;                                          /* index into schema.types, or -1 */
    const struct yaml_node *values[SCHEMA_MAX_FIELDS]; /* by field; NULL: not given */
    bool good[SCHEMA_MAX_FIELDS];                      /* not given and not required, or given and right */
};

/* Reads node by the schema into the struct at item, whose members keep their values where keys are missing
 * or wrong. Reports unknown, doubled, misplaced and missing keys and wrong values. */
void schema_read(struct diagnostics *report, const struct schema *schema, const struct yaml_node *node,
                 void *item, struct mapping *mapping);

/* Writes what stands at node, for "..., is %s"; returns out. */
const char *schema_describe(const struct yaml_node *node, char out[REPORT_QUOTE_SIZE]);

#endif
