#include "scene/yaml.h"

#include <ctype.h>
#include <errno.h>
#include <string.h>

#include "base/escape.h"

enum {
    MAX_ANCHORS = 100,  /* its time grows with their number times that of nodes and aliases */
    MAX_MARKS = 300000, /* it takes up to 750 bytes and 5 us for each (measured): 20,000 objects */
};

/* Not with fy_token_get_text(), which leaks memory in libfyaml 0.7.12 where a scalar has many escapes. */
static void read_text(struct diagnostics *report, struct fy_token *token, struct yaml_value *value)
{
    struct fy_token_iter *pieces = fy_token_iter_create(token);
    const struct fy_iter_chunk *piece = NULL;
    int error = 0;
    while (pieces && value->length < YAML_TEXT_SIZE &&
           (piece = fy_token_iter_chunk_next(pieces, piece, &error))) {
        size_t room = YAML_TEXT_SIZE - value->length, part = piece->len < room ? piece->len : room;
        memcpy(value->text + value->length, piece->str, part);
        value->length += part;
    }
    value->text[value->length < YAML_TEXT_SIZE ? value->length : YAML_TEXT_SIZE - 1] = '\0';
    report->no_memory = report->no_memory || error || !pieces;
    fy_token_iter_destroy(pieces);
}

static struct fy_node *alias_target(struct fy_node *alias)
{
    return fy_anchor_node(
        fy_document_lookup_anchor_by_token(fy_node_document(alias), fy_node_get_scalar_token(alias)));
}

struct yaml_value yaml_read(struct diagnostics *report, struct fy_node *node, struct fy_node *around)
{
    struct yaml_value value = {.written = node, .node = fy_node_is_alias(node) ? alias_target(node) : node};
    value.type = fy_node_get_type(value.node);
    struct fy_token *token = fy_node_get_scalar_token(value.node);
    value.plain = value.type == FYNT_SCALAR && fy_node_get_style(value.node) == FYNS_PLAIN;
    if (token)
        read_text(report, token, &value);
    if (value.plain && value.length == 0 && value.node == node)
        value.written = around;
    return value;
}

static struct scene_place mark_place(const struct fy_mark *mark)
{
    return mark ? (struct scene_place){mark->line + 1, mark->column + 1} : (struct scene_place){1, 1};
}

/* The start of a list or mapping is known to the events that libfyaml makes of a document, and nowhere else.
 */
struct scene_place yaml_place(struct diagnostics *report, struct fy_node *node)
{
    if (!node)
        return (struct scene_place){1, 1};
    struct fy_document_iterator *iterator = fy_document_iterator_create();
    fy_document_iterator_node_start(iterator, node);
    struct fy_event *event = fy_document_iterator_body_next(iterator);
    struct scene_place place = mark_place(fy_event_start_mark(event));
    enum fy_node_style style = fy_node_get_style(node);
    if (style == FYNS_ALIAS || style == FYNS_SINGLE_QUOTED || style == FYNS_DOUBLE_QUOTED)
        place.column--; /* the mark stands behind the asterisk or the quote */
    report->no_memory = report->no_memory || !event;
    fy_document_iterator_event_free(iterator, event);
    fy_document_iterator_destroy(iterator);
    return place;
}

/* Bytes of the character at text that may stand in a scene file, or 0. */
static size_t printable_character(const char *text, size_t length)
{
    uint32_t code = 0;
    const size_t size = utf8_decode(text, length, &code);
    const bool printable = code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code < 0x7F) ||
                           (code >= 0xA0 && code != 0xFFFE && code != 0xFFFF);
    return printable ? size : 0;
}

/* Whether an anchor may begin at text[at]; in a text of several words that is "&" before one of them. */
static bool may_be_anchor(const char *text, size_t length, size_t at)
{
    return text[at] == '&' && at + 1 < length && !isspace((unsigned char)text[at + 1]) &&
           (at == 0 || !isalnum((unsigned char)text[at - 1]));
}

/* Whether the character at text[at] may begin, part or end a value: there are at most so many values, tokens
 * and pieces of tokens as such characters. */
static bool is_mark(const char *text, size_t length, size_t at)
{
    const bool before_blank = at + 1 == length || isspace((unsigned char)text[at + 1]);
    return strchr(",[{:'!*", text[at]) || (before_blank && (text[at] == '-' || text[at] == '?'));
}

/* What libfyaml 0.7.12 does not say no to, or takes too long to: it drops what follows a NUL or bad UTF-8,
 * and its time grows with the square of a directive's length. */
static void check_characters(struct diagnostics *report)
{
    const char *text = report->text;
    struct scene_place place = {1, 1};
    int anchors = 0, marks = 0;
    for (size_t at = 0, size; at < report->length && report->count == 0; at += size) {
        size = printable_character(text + at, report->length - at);
        anchors += may_be_anchor(text, report->length, at);
        marks += is_mark(text, report->length, at);
        if (size == 0)
            report_error(report, place, "must be printable UTF-8 text, has the byte 0x%02X",
                         (unsigned char)text[at]);
        else if (anchors > MAX_ANCHORS)
            report_error(report, place, "more than %d anchors", MAX_ANCHORS);
        else if (marks > MAX_MARKS)
            report_error(report, place, "more than %d values; many spheres belong into an array", MAX_MARKS);
        else if (text[at] == '%' && place.column == 1)
            report_error(report, place, "scene files have no YAML directives");
        place.column++;
        if (text[at] == '\n' || (text[at] == '\r' && (at + 1 == report->length || text[at + 1] != '\n')))
            place = (struct scene_place){place.line + 1, 1};
    }
}

/* The one document, or NULL where the text has none or more, or is not YAML. */
static struct fy_document *parse(struct diagnostics *report, struct fy_parser *parser, struct fy_diag *diag)
{
    struct fy_document *document = fy_parse_load_document(parser);
    struct fy_document *second = document ? fy_parse_load_document(parser) : NULL;
    if (second)
        report_error(report, mark_place(fy_document_state_start_mark(fy_document_get_document_state(second))),
                     "a second document; a scene file must hold one");
    fy_document_destroy(second);
    void *previous = NULL;
    for (struct fy_diag_error *error; (error = fy_diag_errors_iterate(diag, &previous));)
        if (error->type == FYET_ERROR)
            report_error(report, (struct scene_place){error->line, error->column}, "YAML syntax: %s",
                         error->msg);
    if (report->count == 0 && errno != ENOMEM && fy_parser_get_stream_error(parser))
        report_error(report, (struct scene_place){1, 1}, "not YAML 1.2 from here on");
    return document;
}

/* Whether an alias stands for a node before it, all of which have been marked, that it is no part of. */
static bool is_known(struct fy_node *alias, struct fy_node *target)
{
    for (struct fy_node *parent = alias; parent; parent = fy_node_get_document_parent(parent))
        if (parent == target)
            return false;
    return target && fy_node_is_marker_set(target, 0);
}

static void check_node(struct diagnostics *report, struct fy_node *node)
{
    struct fy_token *tag = fy_node_get_tag_token(node);
    if (tag)
        report_error(report, mark_place(fy_token_start_mark(tag)),
                     "scene files have no YAML tags (\"!...\")");
    bool alias = fy_node_is_alias(node), quoted = fy_node_get_style(node) == FYNS_SINGLE_QUOTED;
    if (alias && !is_known(node, alias_target(node))) {
        struct yaml_value name = {.written = node};
        char quote[REPORT_QUOTE_SIZE];
        read_text(report, fy_node_get_scalar_token(node), &name);
        report_error(report, yaml_place(report, node), "alias %s: no such anchor before it",
                     report_quote(name.text, name.length, quote));
    }
    if (quoted && strstr(yaml_read(report, node, NULL).text, "''")) /* 0.7.12 makes 3 of the 2 in 'a''''b' */
        report_error(report, yaml_place(report, node),
                     "quotes in a row: this text needs double quotes around it");
}

static void check_nodes(struct diagnostics *report, struct fy_document *document)
{
    struct fy_document_iterator *iterator = fy_document_iterator_create();
    fy_document_iterator_node_start(iterator, fy_document_root(document));
    for (struct fy_node *node; (node = fy_document_iterator_node_next(iterator));) {
        fy_node_set_marker(node, 0);
        check_node(report, node);
    }
    report->no_memory = report->no_memory || fy_document_iterator_get_error(iterator);
    fy_document_iterator_destroy(iterator);
}

struct fy_document *yaml_load(struct diagnostics *report)
{
    check_characters(report);
    if (report->count > 0)
        return NULL;
    struct fy_diag_cfg quiet;
    fy_diag_cfg_default(&quiet);
    quiet.fp = NULL;
    struct fy_diag *diag = fy_diag_create(&quiet);
    fy_diag_set_collect_errors(diag, true);
    errno = 0;
    struct fy_parser *parser = fy_parser_create(&(struct fy_parse_cfg){
        .search_path = "",
        .flags = FYPCF_DEFAULT_VERSION_1_2 | FYPCF_JSON_NONE | FYPCF_ALLOW_DUPLICATE_KEYS,
        .diag = diag,
    });
    struct fy_document *document = NULL;
    if (diag && parser && fy_parser_set_string(parser, report->text, report->length) == 0)
        document = parse(report, parser, diag);
    else
        report->no_memory = true;
    if (document && report->count == 0)
        check_nodes(report, document);
    report->no_memory = report->no_memory || errno == ENOMEM;
    fy_parser_destroy(parser);
    fy_diag_destroy(diag);
    if (report->count == 0 && !report->no_memory)
        return document;
    fy_document_destroy(document);
    return NULL;
}
