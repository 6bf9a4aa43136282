#include "scene/schema.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

static bool text_is(const struct yaml_node *node, const char *text)
{
    return node->type == YAML_SCALAR && node->length == strlen(text) &&
           memcmp(node->text, text, node->length) == 0;
}

static bool is_number(const struct yaml_node *node, double *value)
{
    return node->type == YAML_SCALAR && node->plain && parse_double(node->text, node->length, value);
}

const char *schema_describe(const struct yaml_node *node, char out[REPORT_QUOTE_SIZE])
{
    double value;
    if (is_number(node, &value) && node->length < REPORT_QUOTE_SIZE)
        snprintf(out, REPORT_QUOTE_SIZE, "%.*s", (int)node->length, node->text);
    else if (yaml_is_empty(node))
        snprintf(out, REPORT_QUOTE_SIZE, "empty");
    else if (node->type == YAML_SCALAR)
        report_quote(node->text, node->length, out);
    else
        snprintf(out, REPORT_QUOTE_SIZE, node->type == YAML_SEQUENCE ? "a list" : "a mapping");
    return out;
}

/* Writes names as "a, b and c", cut where there is no room. */
static void list_names(char *out, size_t size, const char *const *names, size_t count, const char *last_word)
{
    size_t used = 0;
    out[0] = '\0';
    for (size_t i = 0; i < count && used < size; i++) {
        const char *separator = i == 0 ? "" : i + 1 < count ? ", " : last_word;
        used += (size_t)snprintf(out + used, size - used, "%s%s", separator, names[i]);
    }
}

static const struct yaml_node *find_value(const struct yaml_node *mapping, const char *key)
{
    for (const struct yaml_node *at = mapping->child; at && at->next; at = at->next->next)
        if (text_is(at, key))
            return at->next;
    return NULL;
}

static bool takes(const struct field *field, int type)
{
    return type < 0 || field->types == 0 || (field->types >> type & 1) != 0;
}

static void find_type_and_label(const struct schema *schema, struct mapping *mapping)
{
    const struct yaml_node *type = schema->types ? find_value(mapping->node, "type") : NULL;
    for (size_t i = 0; type && i < schema->type_count; i++)
        if (text_is(type, schema->types[i]))
            mapping->type = (int)i;

    const char *label = mapping->type < 0 ? schema->label : schema->labels[mapping->type];
    const struct yaml_node *name = find_value(mapping->node, "name");
    char quote[REPORT_QUOTE_SIZE] = "";
    if (name && name->type == YAML_SCALAR)
        report_quote(name->text, name->length, quote);
    if (label[0])
        snprintf(mapping->label, sizeof(mapping->label), "%s%s%s: ", label, quote[0] ? " " : "", quote);
}

static void report_key(struct diagnostics *report, const struct schema *schema, const struct mapping *mapping,
                       const struct yaml_node *key, const char *problem)
{
    const char *names[SCHEMA_MAX_FIELDS];
    size_t count = 0;
    for (size_t i = 0; i < schema->field_count; i++)
        if (takes(&schema->fields[i], mapping->type))
            names[count++] = schema->fields[i].name;
    char list[256], found[REPORT_QUOTE_SIZE];
    list_names(list, sizeof(list), names, count, " and ");
    report_error(report, key->place, "%s%s %s; the keys here are %s", mapping->label, problem,
                 schema_describe(key, found), list);
}

static void find_keys(struct diagnostics *report, const struct schema *schema, struct mapping *mapping)
{
    int first_lines[SCHEMA_MAX_FIELDS] = {0};
    for (const struct yaml_node *key = mapping->node->child; key && key->next; key = key->next->next) {
        size_t i = 0;
        while (i < schema->field_count && !text_is(key, schema->fields[i].name))
            i++;
        if (key->type == YAML_BROKEN)
            continue;
        if (i == schema->field_count)
            report_key(report, schema, mapping, key,
                       key->type == YAML_SCALAR ? "unknown key" : "a key must be a word, is");
        else if (first_lines[i])
            report_error(report, key->place, "%skey \"%s\" is given twice, first in line %d", mapping->label,
                         schema->fields[i].name, first_lines[i]);
        else if (!takes(&schema->fields[i], mapping->type))
            report_key(report, schema, mapping, key, "takes no key");
        else
            mapping->values[i] = key->next;
        if (i < schema->field_count && !first_lines[i])
            first_lines[i] = key->place.line;
    }
}

static bool check_type(struct diagnostics *report, const struct schema *schema, const struct mapping *mapping,
                       const struct yaml_node *node)
{
    if (mapping->type >= 0)
        return true;
    char list[128], found[REPORT_QUOTE_SIZE];
    list_names(list, sizeof(list), schema->types, schema->type_count, " or ");
    report_error(report, node->place, "%stype must be %s, is %s", mapping->label, list,
                 schema_describe(node, found));
    return false;
}

static bool read_name(struct diagnostics *report, const struct mapping *mapping, const struct yaml_node *node,
                      char **name)
{
    bool printable = node->type == YAML_SCALAR && node->length > 0;
    for (size_t i = 0; printable && i < node->length; i++)
        printable = (unsigned char)node->text[i] >= 0x20 && node->text[i] != 0x7F;
    if (!printable) {
        char found[REPORT_QUOTE_SIZE];
        report_error(report, node->place, "%sname must be a word or text in one line, is %s", mapping->label,
                     schema_describe(node, found));
        return false;
    }
    *name = strndup(node->text, node->length);
    if (!*name)
        report->no_memory = true;
    return *name != NULL;
}

static bool read_number(struct diagnostics *report, const struct mapping *mapping, const struct field *field,
                        const struct yaml_node *node, double *number)
{
    char found[REPORT_QUOTE_SIZE];
    double value;
    if (!is_number(node, &value)) {
        report_error(report, node->place, "%s%s must be a finite decimal number%s, is %s", mapping->label,
                     field->name, field->kind == FIELD_VECTOR ? " in each component" : "",
                     schema_describe(node, found));
        return false;
    }
    for (const struct bound *bound = field->bounds; bound && bound->rule; bound++) {
        bool outside = bound->open ? value <= bound->least || value >= bound->most
                                   : value < bound->least || value > bound->most;
        if (!outside)
            continue;
        report_error(report, node->place, "%s%s must be %s, is %s", mapping->label, field->name, bound->rule,
                     schema_describe(node, found));
        return false;
    }
    *number = value;
    return true;
}

static bool read_vector(struct diagnostics *report, const struct mapping *mapping, const struct field *field,
                        const struct yaml_node *node, double vector[3])
{
    if (node->type != YAML_SEQUENCE || node->count != 3) {
        char found[REPORT_QUOTE_SIZE];
        if (node->type == YAML_SEQUENCE)
            snprintf(found, sizeof(found), "a list of %zu", node->count);
        else
            schema_describe(node, found);
        report_error(report, node->place, "%s%s must be a list of 3 numbers, is %s", mapping->label,
                     field->name, found);
        return false;
    }
    bool good = true;
    for (const struct yaml_node *item = node->child; item; item = item->next)
        good = item->type != YAML_BROKEN && read_number(report, mapping, field, item, vector++) && good;
    return good;
}

static bool read_count(struct diagnostics *report, const struct mapping *mapping, const struct field *field,
                       const struct yaml_node *node, unsigned *count)
{
    unsigned long value;
    const struct bound *bound = field->bounds;
    if (node->type == YAML_SCALAR && node->plain &&
        parse_unsigned(node->text, node->length, UINT_MAX, &value) && (double)value >= bound->least &&
        (double)value <= bound->most) {
        *count = (unsigned)value;
        return true;
    }
    char found[REPORT_QUOTE_SIZE];
    report_error(report, node->place, "%s%s must be a whole number within %.0f..%.0f, is %s", mapping->label,
                 field->name, bound->least, bound->most, schema_describe(node, found));
    return false;
}

static bool read_field(struct diagnostics *report, const struct schema *schema, const struct mapping *mapping,
                       const struct field *field, const struct yaml_node *node, void *item)
{
    void *member = (char *)item + field->offset;
    if (node->type == YAML_BROKEN)
        return false;
    switch (field->kind) {
    case FIELD_TYPE:
        return check_type(report, schema, mapping, node);
    case FIELD_NAME:
        return read_name(report, mapping, node, member);
    case FIELD_NUMBER:
        return read_number(report, mapping, field, node, member);
    case FIELD_VECTOR:
        return read_vector(report, mapping, field, node, member);
    case FIELD_COUNT:
        return read_count(report, mapping, field, node, member);
    case FIELD_NODE:
        break;
    }
    return true;
}

void schema_read(struct diagnostics *report, const struct schema *schema, const struct yaml_node *node,
                 void *item, struct mapping *mapping)
{
    *mapping = (struct mapping){.node = node, .type = -1};
    if (node->type == YAML_BROKEN)
        return;
    if (node->type != YAML_MAPPING) {
        char found[REPORT_QUOTE_SIZE];
        report_error(report, node->place, "%s must be a mapping (\"key: value\"), is %s",
                     schema->label[0] ? schema->label : "a scene file", schema_describe(node, found));
        return;
    }
    find_type_and_label(schema, mapping);
    find_keys(report, schema, mapping);
    for (size_t i = 0; i < schema->field_count; i++) {
        const struct field *field = &schema->fields[i];
        if (mapping->values[i]) {
            mapping->good[i] = read_field(report, schema, mapping, field, mapping->values[i], item);
        } else if (field->required && (field->types == 0 || mapping->type >= 0) &&
                   takes(field, mapping->type)) {
            report_error(report, node->place, "%smissing key \"%s\"", mapping->label, field->name);
        } else {
            mapping->good[i] = !field->required;
        }
    }
}
