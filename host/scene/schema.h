#ifndef VKWHITTED_SCENE_SCHEMA_H
#define VKWHITTED_SCENE_SCHEMA_H

#include "scene/yaml.h"

/* Which keys a mapping of a scene file takes, and reading such a mapping into a struct. */

enum { SCHEMA_MAX_FIELDS = 16 };

/* A bound on a number, with the words for "must be ...". Lists of bounds end with one without a rule. */
struct bound {
    double least, most;
    bool open; /* least and most themselves are outside */
    const char *rule;
};

struct mapping;
struct field;
typedef void field_reader(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
                          void *member);

struct field {
    const char *name;
    field_reader *read; /* NULL: only found */
    bool required;
    unsigned types; /* bit set of the types that take it; 0: all */
    size_t offset;  /* in the struct read into */
    const struct bound *bounds;
};

field_reader read_type;   /* one of schema.types; goes to mapping.type */
field_reader read_name;   /* to char *, allocated: not empty, no control characters */
field_reader read_number; /* to double */
field_reader read_vector; /* to double[3] */
field_reader read_count;  /* to unsigned */

struct schema {
    const char *label;          /* "material", for messages; "" for the whole file */
    bool type_alone;            /* an object of type sphere is called sphere, not sphere object */
    const char *const *types;   /* ends with NULL; NULL where there is no key "type" */
    const struct field *fields; /* ends with a nameless one */
};

/* A mapping that is being read. */
struct mapping {
    struct diagnostics *report;
    const struct schema *schema;
    struct yaml_value value;
    char label[2 * REPORT_QUOTE_SIZE]; /* begins its messages: "sphere "Ball": " */
    int type;                          /* index into schema.types, or -1 */
    bool good;                         /* nothing of it was refused */
};

/* Reads node by the schema into the struct at item, whose members keep their values where keys are missing
 * or wrong. Reports unknown, doubled, misplaced and missing keys and wrong values. */
void schema_read(struct diagnostics *report, const struct schema *schema, struct fy_node *node, void *item,
                 struct mapping *mapping);

/* The value that the key is given first; written is NULL where it is not given. */
struct yaml_value schema_find(const struct mapping *mapping, const char *key);

/* Reports an error at node, with the mapping's label before the message. */
__attribute__((format(printf, 3, 4))) void schema_refuse(struct mapping *mapping, struct fy_node *node,
                                                         const char *format, ...);

/* Reports "<key> must be <expected>, is <value>". */
void schema_expect(struct mapping *mapping, const struct yaml_value *value, const char *key,
                   const char *expected);

#endif
