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
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    struct scene_place place = {1, 1};
    if (mapping->report->count < REPORT_MAX_ERRORS) /* others are only counted */
        place = yaml_place(mapping->report, node);
    report_error(mapping->report, place, "%s%s", mapping->label, message);
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

/* Writes names as "a, b and c", cut where there is no room. */
static void list_names(char *out, size_t size, const char *const *names, size_t count, const char *last_word)
{
    size_t used = 0;
    for (size_t i = 0; i < count && used < size; i++) {
        const char *separator = i == 0 ? "" : i + 1 < count ? ", " : last_word;
        used += (size_t)snprintf(out + used, size - used, "%s%s", separator, names[i]);
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
        const struct yaml_value found = yaml_read(mapping->report, fy_node_pair_key(pair));
        if (is_text(&found, key))
            return yaml_read(mapping->report, fy_node_pair_value(pair));
    }
    return (struct yaml_value){.written = NULL};
}

static void find_type_and_label(struct mapping *mapping)
{
    const struct schema *schema = mapping->schema;
    const struct yaml_value given = schema_find(mapping, "type"), name = schema_find(mapping, "name");
    for (int i = 0; schema->types && schema->types[i]; i++)
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
    const char *names[SCHEMA_MAX_FIELDS];
    size_t count = 0;
    for (const struct field *field = mapping->schema->fields; field->name; field++)
        if (takes(field, mapping->type))
            names[count++] = field->name;
    char list[256] = "", quote[REPORT_QUOTE_SIZE];
    list_names(list, sizeof(list), names, count, " and ");
    schema_refuse(mapping, key->written, "%s %s; the keys here are %s", problem, describe(key, quote), list);
}

void read_type(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
               void *member)
{
    (void)member;
    char list[128] = "";
    size_t count = 0;
    while (mapping->schema->types[count])
        count++;
    list_names(list, sizeof(list), mapping->schema->types, count, " or ");
    if (mapping->type < 0)
        schema_expect(mapping, value, field->name, list);
}

void read_name(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
               void *member)
{
    char **name = member;
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

void read_number(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
                 void *member)
{
    double number;
    const char *expected = NULL;
    if (!is_number(value, &number))
        expected = field->read == read_vector ? "a finite decimal number in each component"
                                              : "a finite decimal number";
    for (const struct bound *bound = field->bounds; bound && bound->rule && !expected; bound++)
        if (bound->open ? number <= bound->least || number >= bound->most
                        : number < bound->least || number > bound->most)
            expected = bound->rule;
    if (expected)
        schema_expect(mapping, value, field->name, expected);
    else
        *(double *)member = number;
}

void read_vector(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
                 void *member)
{
    double *component = member;
    int count = fy_node_sequence_item_count(value->node);
    if (value->type != FYNT_SEQUENCE) {
        schema_expect(mapping, value, field->name, "a list of 3 numbers");
        return;
    }
    if (count != 3) {
        schema_refuse(mapping, value->written, "%s must be a list of 3 numbers, is a list of %d", field->name,
                      count);
        return;
    }
    struct fy_node *item;
    for (void *at = NULL; (item = fy_node_sequence_iterate(value->node, &at));) {
        struct yaml_value number = yaml_read(mapping->report, item);
        read_number(mapping, field, &number, component++);
    }
}

void read_count(struct mapping *mapping, const struct field *field, const struct yaml_value *value,
                void *member)
{
    unsigned long count;
    const struct bound *bound = field->bounds;
    char expected[64];
    snprintf(expected, sizeof expected, "a whole number within %.0f..%.0f", bound->least, bound->most);
    if (value->plain && parse_unsigned(value->text, value->length, UINT_MAX, &count) &&
        (double)count >= bound->least && (double)count <= bound->most)
        *(unsigned *)member = (unsigned)count;
    else
        schema_expect(mapping, value, field->name, expected);
}

/* Reads what stands behind a key, unless its field has a first key already. */
static void read_pair(struct mapping *mapping, struct fy_node_pair *pair, void *item,
                      struct fy_node *first_keys[])
{
    const struct field *fields = mapping->schema->fields;
    const struct yaml_value key = yaml_read(mapping->report, fy_node_pair_key(pair));
    size_t i = 0;
    while (fields[i].name && !is_text(&key, fields[i].name))
        i++;
    if (!fields[i].name) {
        refuse_key(mapping, &key, key.type == FYNT_SCALAR ? "unknown key" : "a key must be a word, is");
        return;
    }
    if (first_keys[i]) {
        schema_refuse(mapping, key.written, "key \"%s\" is given twice, first in line %d", fields[i].name,
                      yaml_place(mapping->report, first_keys[i]).line);
        return;
    }
    first_keys[i] = key.written;
    if (!takes(&fields[i], mapping->type)) {
        refuse_key(mapping, &key, "takes no key");
    } else if (fields[i].read) {
        const struct yaml_value value = yaml_read(mapping->report, fy_node_pair_value(pair));
        fields[i].read(mapping, &fields[i], &value, (char *)item + fields[i].offset);
    }
}

void schema_read(struct diagnostics *report, const struct schema *schema, struct fy_node *node, void *item,
                 struct mapping *mapping)
{
    *mapping = (struct mapping){report, schema, yaml_read(report, node), .type = -1, .good = true};
    if (mapping->value.type != FYNT_MAPPING) {
        schema_expect(mapping, &mapping->value, schema->label[0] ? schema->label : "a scene file",
                      "a mapping (\"key: value\")");
        return;
    }
    find_type_and_label(mapping);
    struct fy_node *first_keys[SCHEMA_MAX_FIELDS] = {NULL};
    struct fy_node_pair *pair;
    for (void *at = NULL; (pair = fy_node_mapping_iterate(mapping->value.node, &at));)
        read_pair(mapping, pair, item, first_keys);
    for (size_t i = 0; schema->fields[i].name; i++) {
        const struct field *field = &schema->fields[i];
        if (field->required && !first_keys[i] && (field->types == 0 || mapping->type >= 0) &&
            takes(field, mapping->type))
            schema_refuse(mapping, node, "missing key \"%s\"", field->name);
    }
}
