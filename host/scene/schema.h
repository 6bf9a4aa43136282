#ifndef VKWHITTED_SCENE_SCHEMA_H
#define VKWHITTED_SCENE_SCHEMA_H

#include "scene/yaml.h"

/* Which keys a mapping of a scene file takes, and reading such a mapping into a struct. */

enum { MAX_FIELDS = 16 }; /* of a schema; the last has no name */

/* Bounds of a number, both inside, with the words for "must be ...". */
struct bounds {
    double least, most;
    const char *rule;
    bool positive; /* 0 and less are refused with "> 0" */
};

struct mapping;
struct field;
typedef void field_reader(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
                          void *to);

struct field {
    const char *name;
    field_reader *read; /* NULL: only found */
    bool required;
    unsigned types;              /* bit set of the types that take it; 0: all */
    size_t offset;               /* in the struct read into */
    const struct bounds *bounds; /* NULL: none */
};

field_reader read_type;   /* one of schema.types, to unsigned or enum */
field_reader read_name;   /* to char *, allocated: not empty, no control characters */
field_reader read_number; /* to double */
field_reader read_vector; /* to double[3] */
field_reader read_count;  /* to unsigned */

struct schema {
    const char *label;    /* "material", for messages; "" for the whole file */
    bool type_alone;      /* an object of type sphere is called sphere, not sphere object */
    const char *types[4]; /* what the key "type" can be; ends with NULL, as the fields do */
    const struct field *fields;
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

/* Reads the value by the schema into the struct at item, whose members keep their values where keys are
 * missing or wrong. Reports unknown, doubled, misplaced and missing keys and wrong values. */
void schema_read(struct diagnostics *report, const struct schema *schema, const struct yaml_value *value,
                 void *item, struct mapping *mapping);

/* The value that the key is given first; written is NULL where it is not given. */
struct yaml_value schema_find(const struct mapping *mapping, const char *key);

/* Reports an error at node, with the mapping's label before the message. */
__attribute__((format(printf, 3, 4))) void schema_refuse(struct mapping *mapping, struct fy_node *node,
                                                         const char *format, ...);

/* Reports "<key> must be <expected>, is <value>". */
void schema_expect(struct mapping *mapping, const struct yaml_value *value, const char *key,
                   const char *expected);

#endif
