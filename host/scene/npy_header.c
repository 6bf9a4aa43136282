#include "scene/npy_header.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "scene/schema.h"

static const unsigned long most_rows = 1UL << 48;

struct reading {
    struct diagnostics *report;
    const char *text; /* the dictionary */
    size_t length;
    struct npy_header *header;
    char *message;
};

enum status npy_refuse(char message[NPY_MESSAGE], const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, NPY_MESSAGE, format, arguments);
    va_end(arguments);
    return STATUS_REFUSED;
}

/* With the list as it is written in the header, up to the character that ends it. */
static enum status refuse_list(const struct reading *reading, const char *what, const struct yaml_value *list,
                               char last)
{
    const char *end = reading->text + reading->length;
    const char *start = reading->text + yaml_place(reading->report, list->written).column - 1;
    const char *found = memchr(start, last, (size_t)(end - start));
    return npy_refuse(reading->message, "%s, is %.*s", what, (int)(found ? found + 1 - start : 0), start);
}

static enum status read_descr(const struct reading *reading, const struct yaml_value *descr)
{
    static const char expected[] = "its dtype must be float32 or float64";
    const char *type = descr->text;
    if (descr->type == FYNT_SEQUENCE) /* structured */
        return refuse_list(reading, expected, descr, ']');
    if (type[0] && strchr("|<>=", type[0]) && type[1] == 'O')
        return npy_refuse(reading->message, "holds pickled Python objects, which are not read");
    if (strcmp(type, "<f4") && strcmp(type, ">f4") && strcmp(type, "<f8") && strcmp(type, ">f8"))
        return npy_refuse(reading->message, "%s, is '%s'", expected, type);
    reading->header->big_endian = type[0] == '>';
    reading->header->value_size = type[2] == '4' ? 4 : 8;
    return STATUS_DONE;
}

/* A number of decimal digits, behind which Python 2 wrote an L. */
static bool read_size(const struct reading *reading, struct fy_node *node, unsigned long *size)
{
    const struct yaml_value value = yaml_read(reading->report, node, NULL);
    const size_t length =
        value.length > 0 && value.text[value.length - 1] == 'L' ? value.length - 1 : value.length;
    return value.plain && parse_unsigned(value.text, length, most_rows, size);
}

static enum status read_shape(const struct reading *reading, const struct yaml_value *shape)
{
    unsigned long rows, columns;
    if (fy_node_sequence_item_count(shape->node) != 2 ||
        !read_size(reading, fy_node_sequence_get_by_index(shape->node, 0), &rows) ||
        !read_size(reading, fy_node_sequence_get_by_index(shape->node, 1), &columns) ||
        columns != NPY_COLUMNS)
        return refuse_list(reading, "its shape must be (N, 4): x, y, z, radius", shape, ')');
    reading->header->rows = rows;
    return STATUS_DONE;
}

static enum status read_dictionary(const struct reading *reading, struct fy_document *document)
{
    struct mapping root = {.report = reading->report};
    if (document)
        root.value = yaml_read(reading->report, fy_document_root(document), NULL);
    const struct yaml_value descr = schema_find(&root, "descr"), order = schema_find(&root, "fortran_order"),
                            shape = schema_find(&root, "shape");
    reading->header->columns_first = strcmp(order.text, "True") == 0;
    if (fy_node_mapping_item_count(root.value.node) != 3 || !descr.written || descr.plain ||
        shape.type != FYNT_SEQUENCE || !(reading->header->columns_first || strcmp(order.text, "False") == 0))
        return npy_refuse(reading->message, "its NumPy header must be a dictionary of 'descr', "
                                            "'fortran_order' and 'shape'");
    enum status status = read_descr(reading, &descr);
    return status == STATUS_DONE ? read_shape(reading, &shape) : status;
}

/* The text is a Python dictionary: {'descr': '<f4', 'fortran_order': False, 'shape': (17, 4), }. With
 * brackets for the parentheses it is YAML. */
static enum status parse_dictionary(const char *text, size_t length, struct npy_header *header,
                                    char message[NPY_MESSAGE])
{
    char yaml[NPY_MOST_HEADER];
    for (size_t i = 0; i < length; ++i)
        yaml[i] = text[i] == '(' ? '[' : text[i] == ')' ? ']' : text[i];
    struct diagnostics report = {.path = "", .text = yaml, .length = length};
    struct fy_document *document = yaml_load(&report);
    enum status status = read_dictionary(&(struct reading){&report, text, length, header, message}, document);
    fy_document_destroy(document);
    report_discard(&report);
    if (!report.no_memory)
        return status;
    npy_refuse(message, "no memory to read its header");
    return STATUS_UNABLE;
}

enum status npy_header_parse(const char *text, size_t length, struct npy_header *header,
                             char message[NPY_MESSAGE])
{
    const unsigned char *bytes = (const unsigned char *)text;
    if (length < 10 || memcmp(text, "\x93NUMPY", 6) != 0)
        return npy_refuse(message, "is not a NumPy file (.npy)");
    if (bytes[6] < 1 || bytes[6] > 3 || bytes[7] != 0)
        return npy_refuse(message, "has version %d.%d of NumPy's format; 1.0, 2.0 and 3.0 are known",
                          bytes[6], bytes[7]);
    size_t before = bytes[6] == 1 ? 10 : 12;
    size_t dictionary = (size_t)(bytes[8] | bytes[9] << 8);
    if (bytes[6] > 1 && length >= 12)
        dictionary |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
    if (dictionary > NPY_MOST_HEADER - before)
        return npy_refuse(message, "has a header of %zu bytes, more than %d", dictionary, NPY_MOST_HEADER);
    if (before + dictionary > length)
        return npy_refuse(message, "is truncated: it ends in its header");
    *header = (struct npy_header){.size = before + dictionary};
    return parse_dictionary(text + before, dictionary, header, message);
}
