#include "scene/schema.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

static bool is_text(const struct yaml_value *value, const char *text)
{
    return value->type == FYNT_SCALAR && value->length == strlen(text) && strcmp(value->text, text) == 0;
}

static bool is_number(const struct yaml_value *value, double *number)
{
    return value->plain && parse_double(value->text, value->length, number);
}

void schema_refuse(struct mapping *mapping, struct fy_node *node, const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    report_error(mapping->report, yaml_place(mapping->report, node), "%s%s", mapping->label, message);
    mapping->good = false;
}

/* What the value is, for "..., is %s". */
static const char *describe(const struct yaml_value *value, char quote[REPORT_QUOTE_SIZE])
{
    double number;
    if (value->type != FYNT_SCALAR)
        return value->type == FYNT_SEQUENCE ? "a list" : "a mapping";
    if (value->plain && value->length == 0)
        return "empty";
    return value->length < REPORT_QUOTE_SIZE && is_number(value, &number)
               ? value->text
               : report_quote(value->text, value->length, quote);
}

void schema_expect(struct mapping *mapping, const struct yaml_value *value, const char *key,
                   const char *expected)
{
    char quote[REPORT_QUOTE_SIZE];
    schema_refuse(mapping, value->written, "%s must be %s, is %s", key, expected, describe(value, quote));
}

enum { LIST_SIZE = 256 };

/* Writes names, which end with NULL, as "a, b and c", cut where there is no room. */
static void list_names(const char *const names[], const char *last_word, char out[LIST_SIZE])
{
    size_t used = 0;
    for (size_t i = 0; names[i] && used < LIST_SIZE; i++) {
        const char *separator = i == 0 ? "" : names[i + 1] ? ", " : last_word;
        used += (size_t)snprintf(out + used, LIST_SIZE - used, "%s%s", separator, names[i]);
    }
}

static bool takes(const struct field *field, int type)
{
    return type < 0 || field->types == 0 || (field->types >> type & 1) != 0;
}

struct yaml_value schema_find(const struct mapping *mapping, const char *key)
{
    struct fy_node_pair *pair;
    for (void *at = NULL; (pair = fy_node_mapping_iterate(mapping->value.node, &at));) {
        const struct yaml_value found = yaml_read(mapping->report, fy_node_pair_key(pair), NULL);
        if (is_text(&found, key))
            return yaml_read(mapping->report, fy_node_pair_value(pair), found.written);
    }
    return (struct yaml_value){.written = NULL};
}

static void find_type_and_label(struct mapping *mapping)
{
    const struct schema *schema = mapping->schema;
    const struct yaml_value given = schema_find(mapping, "type"), name = schema_find(mapping, "name");
    for (int i = 0; schema->types[i]; i++)
        if (is_text(&given, schema->types[i]))
            mapping->type = i;
    const char *type = mapping->type < 0 ? "" : schema->types[mapping->type];
    const char *label = type[0] && schema->type_alone ? "" : schema->label;
    char quote[REPORT_QUOTE_SIZE] = "";
    if (name.written && name.type == FYNT_SCALAR)
        report_quote(name.text, name.length, quote);
    if (schema->label[0])
        snprintf(mapping->label, sizeof(mapping->label), "%s%s%s%s%s: ", type, type[0] && label[0] ? " " : "",
                 label, quote[0] ? " " : "", quote);
}

static void refuse_key(struct mapping *mapping, const struct yaml_value *key, const char *problem)
{
    const char *names[MAX_FIELDS] = {NULL};
    size_t count = 0;
    for (const struct field *field = mapping->schema->fields; field->name; field++)
        if (takes(field, mapping->type))
            names[count++] = field->name;
    char list[LIST_SIZE], quote[REPORT_QUOTE_SIZE];
    list_names(names, " and ", list);
    schema_refuse(mapping, key->written, "%s %s; the keys here are %s", problem, describe(key, quote), list);
}

void read_type(struct mapping *mapping, const struct field *field, const struct yaml_value *value, void *to)
{
    char list[LIST_SIZE];
    list_names(mapping->schema->types, " or ", list);
    if (mapping->type < 0)
        schema_expect(mapping, value, field->name, list);
    else
        *(unsigned *)to = (unsigned)mapping->type;
}

void read_name(struct mapping *mapping, const struct field *field, const struct yaml_value *value, void *to)
{
    char **name = to;
    bool printable = value->length > 0;
    for (size_t i = 0; i < value->length && i < YAML_TEXT_SIZE - 1 && printable; i++)
        printable = (unsigned char)value->text[i] >= 0x20 && value->text[i] != 0x7F;
    if (!printable)
        schema_expect(mapping, value, field->name, "a word or text in one line");
    else if (value->length >= YAML_TEXT_SIZE)
        schema_expect(mapping, value, field->name, "shorter than 512 bytes");
    else if (!(*name = strdup(value->text)))
        mapping->report->no_memory = true;
}

void read_number(struct mapping *mapping, const struct field *field, const struct yaml_value *value, void *to)
{
    double number;
    const struct bounds *bounds = field->bounds;
    const char *expected = NULL;
    if (!is_number(value, &number))
        expected = field->read == read_vector ? "a finite decimal number in each component"
                                              : "a finite decimal number";
    else if (bounds && bounds->positive && number <= 0)
        expected = "> 0";
    else if (bounds && (number < bounds->least || number > bounds->most))
        expected = bounds->rule;
    if (expected)
        schema_expect(mapping, value, field->name, expected);
    else
        *(double *)to = number;
}

void read_vector(struct mapping *mapping, const struct field *field, const struct yaml_value *value, void *to)
{
    double *component = to;
    int count = fy_node_sequence_item_count(value->node);
    if (value->type != FYNT_SEQUENCE)
        schema_expect(mapping, value, field->name, "a list of 3 numbers");
    else if (count != 3)
        schema_refuse(mapping, value->written, "%s must be a list of 3 numbers, is a list of %d", field->name,
                      count);
    void *at = NULL;
    for (struct fy_node *item; count == 3 && (item = fy_node_sequence_iterate(value->node, &at));) {
        const struct yaml_value number = yaml_read(mapping->report, item, value->written);
        read_number(mapping, field, &number, component++);
    }
}

void read_count(struct mapping *mapping, const struct field *field, const struct yaml_value *value, void *to)
{
    unsigned long count;
    const struct bounds *bounds = field->bounds;
    char expected[64];
    snprintf(expected, sizeof expected, "a whole number within %.0f..%.0f", bounds->least, bounds->most);
    if (value->plain && parse_unsigned(value->text, value->length, UINT_MAX, &count) &&
        (double)count >= bounds->least && (double)count <= bounds->most)
        *(unsigned *)to = (unsigned)count;
    else
        schema_expect(mapping, value, field->name, expected);
}

/* Reads what stands behind a key, unless its field has a first key already. */
static void read_pair(struct mapping *mapping, struct fy_node_pair *pair, void *item,
                      struct fy_node *first_keys[])
{
    const struct yaml_value key = yaml_read(mapping->report, fy_node_pair_key(pair), mapping->value.written);
    const struct field *field = mapping->schema->fields;
    while (field->name && !is_text(&key, field->name))
        field++;
    struct fy_node **first = &first_keys[field - mapping->schema->fields];
    if (!field->name) {
        refuse_key(mapping, &key, key.type == FYNT_SCALAR ? "unknown key" : "a key must be a word, is");
    } else if (*first) {
        schema_refuse(mapping, key.written, "key \"%s\" is given twice, first in line %d", field->name,
                      yaml_place(mapping->report, *first).line);
    } else {
        *first = key.written;
        const struct yaml_value value = yaml_read(mapping->report, fy_node_pair_value(pair), key.written);
        if (!takes(field, mapping->type))
            refuse_key(mapping, &key, "takes no key");
        else if (field->read)
            field->read(mapping, field, &value, (char *)item + field->offset);
    }
}

void schema_read(struct diagnostics *report, const struct schema *schema, const struct yaml_value *value,
                 void *item, struct mapping *mapping)
{
    *mapping = (struct mapping){report, schema, *value, .type = -1, .good = true};
    if (value->type != FYNT_MAPPING) {
        schema_expect(mapping, value, schema->label[0] ? schema->label : "a scene file",
                      "a mapping (\"key: value\")");
        return;
    }
    find_type_and_label(mapping);
    struct fy_node *first_keys[MAX_FIELDS] = {NULL};
    struct fy_node_pair *pair;
    for (void *at = NULL; (pair = fy_node_mapping_iterate(value->node, &at));)
        read_pair(mapping, pair, item, first_keys);
    for (const struct field *field = schema->fields; field->name; field++)
        if (field->required && !first_keys[field - schema->fields] && takes(field, mapping->type) &&
            (field->types == 0 || mapping->type >= 0))
            schema_refuse(mapping, value->written, "missing key \"%s\"", field->name);
}
